//! The comparator on the plant: its input, and the supply that it cuts.

use thermal_plant::comparator::ComparatorTest;
use thermal_sim::scene::FaultKind;

use super::*;

const HEATING: (f64, f64) = (0.6, 1.0);

/// Heats until the supply is cut, at most 5 s, with things broken; the display's temperature then.
fn heated(world: &mut World, all: &[ActiveFault]) -> Option<f64> {
    for _ in 0..5000 {
        run(world, 1, driven(HEATING.0, HEATING.1), all);
        if world.plant().supply_cut() {
            return Some(world.plant().display_c());
        }
    }
    None
}

#[test]
fn hot_display_ends_the_current_whatever_the_legs_do() {
    let mut world = ideal();
    let cut_c = heated(&mut world, &[]).expect("cut");
    // Its thermistor lags by 0.1 s behind some 10 K/s.
    assert!((45.0..47.0).contains(&cut_c), "{cut_c}");
    assert!(world.bridge_fault(), "nFAULT is low");
    for all in [&[][..], &[FaultKind::BridgeEnableStuck.into(), FaultKind::BridgeStuckLow.into()]] {
        run(&mut world, 1, driven(HEATING.0, HEATING.1), all);
        assert_eq!(world.plant().current_a(), 0.0);
    }
    // It stays cut when the display is back within.
    run(&mut world, 20_000, driven(HEATING.0, HEATING.1), &[]);
    assert!(world.plant().display_c() < 40.0);
    assert!(world.plant().supply_cut());
    assert_eq!(world.plant().current_a(), 0.0);
    // Until the device has tested it.
    world.comparator_test(ComparatorTest::Hot);
    assert!(world.bridge_fault());
    world.comparator_test(ComparatorTest::None);
    run(&mut world, 20, OFF, &[]);
    assert!(!world.bridge_fault());
    run(&mut world, 1, driven(HEATING.0, HEATING.1), &[]);
    assert!(world.plant().current_a() < -3.0);
}

#[test]
fn cold_display_ends_the_current() {
    let mut world = ideal();
    let mut last_c = 24.0;
    for _ in 0..10_000 {
        run(&mut world, 1, driven(1.0, 0.6), &[]);
        if world.plant().supply_cut() {
            break;
        }
        last_c = world.plant().display_c();
    }
    assert!((8.0..10.0).contains(&last_c), "{last_c}");
    run(&mut world, 1, driven(1.0, 0.6), &[]);
    assert_eq!(world.plant().current_a(), 0.0);
}

#[test]
fn dead_comparator_lets_the_display_burn_and_its_test_shows_that() {
    let mut world = ideal();
    let dead = [FaultKind::ComparatorDead.into()];
    assert_eq!(heated(&mut world, &dead), None);
    assert!(world.plant().display_c() > 55.0);
    for test in [ComparatorTest::Hot, ComparatorTest::Cold] {
        world.comparator_test(test);
        assert!(!world.bridge_fault(), "a sound one pulls nFAULT here");
    }
}

#[test]
fn stuck_comparator_keeps_the_supply_off() {
    let mut world = ideal();
    let stuck = [FaultKind::ComparatorStuck.into()];
    run(&mut world, 2, driven(1.0, 0.6), &stuck);
    world.comparator_test(ComparatorTest::Hot);
    world.comparator_test(ComparatorTest::None);
    run(&mut world, 20, driven(1.0, 0.6), &stuck);
    assert_eq!(world.plant().current_a(), 0.0);
    assert!(world.bridge_fault());
    let unseen = [FaultKind::ComparatorStuck, FaultKind::FaultPinDead].map(ActiveFault::from);
    run(&mut world, 1, driven(1.0, 0.6), &unseen);
    assert!(!world.bridge_fault(), "the pin hides it");
    assert_eq!(world.plant().current_a(), 0.0);
}

/// Its input is the check thermistor's pin: faults there act on it, those of the other four or of the converter do not.
#[test]
fn it_sees_the_second_thermistors_pin_alone() {
    let swapped =
        ActiveFault { with: Sensor::Check, ..of(FaultKind::SensorsSwapped, Sensor::Room, 0.0) };
    for (all, cut) in [
        (vec![of(FaultKind::ThermistorOpen, Sensor::Check, 0.0)], true),
        (vec![of(FaultKind::ThermistorShort, Sensor::Check, 0.0)], true),
        (vec![of(FaultKind::ThermistorOffset, Sensor::Check, 20.9)], false),
        (vec![of(FaultKind::ThermistorOffset, Sensor::Check, 21.1)], true),
        (vec![of(FaultKind::ThermistorDrift, Sensor::Check, -14.1)], true),
        (vec![FaultKind::ReferenceOff.into()], true),
        (vec![FaultKind::AdcStuck.into()], false),
        (vec![of(FaultKind::ThermistorOpen, Sensor::Display, 0.0)], false),
        (vec![of(FaultKind::ThermistorShort, Sensor::Room, 0.0)], false),
        (vec![swapped], false),
        (vec![swapped, of(FaultKind::ThermistorShort, Sensor::Room, 0.0)], true),
    ] {
        let mut world = ideal();
        run(&mut world, 2, OFF, &all);
        assert_eq!(world.plant().supply_cut(), cut, "{all:?}");
    }
}

/// Neither a channel that is stuck nor a loose thermistor changes its threshold; the loose one is late.
#[test]
fn stuck_code_does_not_hide_the_heat_and_a_loose_thermistor_does() {
    let stuck = of(FaultKind::ThermistorStuck, Sensor::Check, 0.0);
    let cut_c = heated(&mut ideal(), &[stuck]).expect("cut");
    assert!((45.0..47.0).contains(&cut_c), "{cut_c}");
    let loose = of(FaultKind::ThermistorDetached, Sensor::Check, 20.0);
    let late_c = heated(&mut ideal(), &[loose]).expect("cut");
    assert!(late_c > 55.0, "{late_c}");
}

/// A ladder that is 0.3 K off, as the box has it.
#[test]
fn threshold_is_a_parameter() {
    for (offset_k, cut) in [(21.2, false), (21.4, true)] {
        let mut world = connected(&format!("{IDEAL}comparator.hot_c = 45.3\n"));
        run(&mut world, 2, OFF, &[of(FaultKind::ThermistorOffset, Sensor::Check, offset_k)]);
        assert_eq!(world.plant().supply_cut(), cut, "{offset_k} K");
    }
}

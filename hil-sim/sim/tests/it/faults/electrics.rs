//! Bridge, supply and current measurement, by Ohm's law on a tile without a temperature difference: MOSFETs, inductors and
//! tile are some 1.11 ohm on 12 V.

use thermal_sim::scene::FaultKind;

use super::*;

/// Current of the first step from rest, A: there is no Seebeck voltage yet.
fn current_a(legs: BridgeOutputs, all: &[ActiveFault]) -> f64 {
    let mut world = ideal();
    // The supply rises by 9 V/ms.
    run(&mut world, 3, OFF, all);
    run(&mut world, 1, legs, all);
    world.plant().current_a()
}

const COOLING: (f64, f64) = (1.0, 0.6);
const HEATING: (f64, f64) = (0.6, 1.0);

fn legs((a, b): (f64, f64)) -> BridgeOutputs {
    driven(a, b)
}

#[test]
fn current_is_in_proportion_to_the_supply() {
    let full = driven(1.0, 0.0);
    let nominal_a = current_a(full, &[]);
    assert!((10.0..11.0).contains(&nominal_a), "{nominal_a} A");
    for (kind, supply_v) in
        [(FaultKind::SupplyLow, 6.0), (FaultKind::SupplyLow, 9.0), (FaultKind::SupplyHigh, 24.0)]
    {
        let share = current_a(full, &[broken(kind, supply_v)]) / nominal_a;
        assert!(
            // The driver's 7.5 mA take 0.3 mV from the supply.
            (share - (supply_v - 0.34e-3) / (12.0 - 0.34e-3)).abs() < 1e-6,
            "{supply_v} V: {share}"
        );
    }
}

#[test]
fn supply_comes_back() {
    let mut world = ideal();
    let full = driven(1.0, 0.0);
    run(&mut world, 1, full, &[broken(FaultKind::SupplyLow, 6.0)]);
    let low_a = world.plant().current_a();
    run(&mut world, 1, full, &[]);
    let share = world.plant().current_a() / low_a;
    assert!((1.9..2.01).contains(&share), "{share}");
}

/// 24 V drive 21 A, which the driver of 49 A does not notice, but one of 20 A.
#[test]
fn high_supply_overloads_a_weak_driver_only() {
    for (tables, overloaded) in [("", false), ("[plant]\nbridge.trip_a = 20\n", true)] {
        let mut world = connected(tables);
        run(&mut world, 3, driven(1.0, 0.0), &[broken(FaultKind::SupplyHigh, 24.0)]);
        assert_eq!(world.bridge_fault(), overloaded, "{tables}");
        assert_eq!(world.plant().current_a() == 0.0, overloaded, "{tables}");
    }
}

#[test]
fn stuck_leg_drives_against_the_other_one() {
    // Each: the duties of the inputs, and the difference of the legs, which times 12 V drives the current. Sound legs
    // are low but for the pulses of one of them.
    for (kind, commanded, difference) in [
        (FaultKind::BridgeStuckHigh, COOLING, 1.0),
        (FaultKind::BridgeStuckHigh, HEATING, 0.6),
        (FaultKind::BridgeBStuckHigh, COOLING, -0.6),
        (FaultKind::BridgeBStuckHigh, HEATING, -1.0),
        (FaultKind::BridgeStuckLow, COOLING, 0.0),
        (FaultKind::BridgeStuckLow, HEATING, -0.4),
        (FaultKind::LegOpen, COOLING, 0.0),
        (FaultKind::LegOpen, HEATING, 0.0),
        (FaultKind::PolaritySwapped, COOLING, -0.4),
        (FaultKind::PolaritySwapped, HEATING, 0.4),
    ] {
        let amperes = current_a(legs(commanded), &[kind.into()]);
        let expected_a = 12.0 * difference / 1.11;
        // Dead time takes some 0.2 V.
        assert!(
            (amperes - expected_a).abs() < 0.4,
            "{kind:?}, commanded {commanded:?}: {amperes} A instead of {expected_a}"
        );
    }
}

#[test]
fn enable_ends_the_current_of_a_stuck_leg() {
    for kind in [
        FaultKind::BridgeStuckHigh,
        FaultKind::BridgeBStuckHigh,
        FaultKind::BridgeStuckLow,
        FaultKind::PolaritySwapped,
    ] {
        let disabled = BridgeOutputs { enabled: false, ..legs(COOLING) };
        assert_eq!(current_a(disabled, &[kind.into()]), 0.0, "{kind:?}");
        assert_eq!(current_a(OFF, &[kind.into()]), 0.0, "{kind:?}");
    }
}

#[test]
fn stuck_enable_drives_for_as_long_as_pwm_does() {
    let disabled = BridgeOutputs { enabled: false, ..legs(COOLING) };
    let stuck = [FaultKind::BridgeEnableStuck.into()];
    assert_eq!(current_a(disabled, &[]), 0.0);
    assert_eq!(current_a(disabled, &stuck), current_a(legs(COOLING), &[]));
    assert_eq!(current_a(OFF, &stuck), 0.0);
}

#[test]
fn short_of_output_a_trips_the_driver_and_a_dead_pin_hides_it() {
    let mut world = ideal();
    run(&mut world, 1, legs(COOLING), &[FaultKind::BridgeShorted.into()]);
    assert!(world.bridge_fault());
    let hidden = [FaultKind::BridgeShorted, FaultKind::FaultPinDead].map(ActiveFault::from);
    run(&mut world, 1, legs(COOLING), &hidden);
    assert!(!world.bridge_fault());
    assert_eq!(world.plant().current_a(), 0.0, "the driver has tripped all the same");
}

#[test]
fn mirror_shows_what_it_is_stuck_at() {
    let mut world = ideal();
    for (legs, amperes) in [(OFF, 3.0), (driven(1.0, 0.0), 0.0)] {
        run(&mut world, 1, legs, &[broken(FaultKind::MirrorStuck, amperes)]);
        // 400 counts/A.
        let code = f64::from(codes(&mut world)[Channel::Current as usize]);
        assert_eq!(code, 400.0 * amperes);
    }
}

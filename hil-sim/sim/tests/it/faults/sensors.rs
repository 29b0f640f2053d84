//! Thermistors and force sensor. Codes are those of the beta equation, worked out apart: 10 k at 25 deg C, 3950 K, behind
//! 10 k.

use thermal_sim::scene::FaultKind;

use super::*;

/// Code of a temperature, deg C.
const AT_24_C: u16 = 2094;
const AT_29_C: u16 = 1869;
const AT_14_C: u16 = 2557;
const AT_34_C: u16 = 1655;
const AT_60_C: u16 = 816;

/// What they read at rest; force, current and supply (12 V) after them.
const REST: [u16; 8] = [AT_24_C, AT_24_C, AT_24_C, AT_34_C, AT_24_C, 410, 0, 3464];

fn after(all: &[ActiveFault]) -> [u16; 8] {
    let mut world = ideal();
    run(&mut world, 1, OFF, all);
    codes(&mut world)
}

#[test]
fn sound_sensors_read_what_is_there() {
    assert_eq!(after(&[]), REST);
}

#[test]
fn each_thermistor_breaks_by_itself() {
    for sensor in Sensor::ALL {
        for (kind, value, code) in [
            (FaultKind::ThermistorOpen, 0.0, Some(4095)),
            (FaultKind::ThermistorShort, 0.0, Some(0)),
            (FaultKind::ThermistorOffset, 5.0, (sensor != Sensor::Skin).then_some(AT_29_C)),
            (FaultKind::ThermistorOffset, -10.0, (sensor == Sensor::Skin).then_some(AT_24_C)),
            (FaultKind::ThermistorOffset, -10.0, (sensor != Sensor::Skin).then_some(AT_14_C)),
            (FaultKind::ThermistorDrift, 5.0, (sensor != Sensor::Skin).then_some(AT_29_C)),
        ] {
            let Some(code) = code else { continue };
            let mut expected = REST;
            expected[sensor as usize] = code;
            assert_eq!(after(&[of(kind, sensor, value)]), expected, "{kind:?} of {sensor:?}");
        }
    }
}

/// A jump is seen whole from the first conversion on: a wire that breaks passes no temperature in between.
#[test]
fn broken_wire_is_seen_at_once() {
    let mut world = ideal();
    run(&mut world, 5, OFF, &[]);
    world.set_force_and_faults(0.0, [FaultKind::ThermistorOpen.into()].into_iter());
    world.step(OFF);
    assert_eq!(world.convert(Channel::Display), 4095);
    world.set_force_and_faults(0.0, std::iter::empty());
    world.step(OFF);
    assert_eq!(world.convert(Channel::Display), AT_24_C);
}

#[test]
fn stuck_channel_repeats_itself_while_the_others_go_on() {
    let mut world = World::new(&scene("")).expect("a plant with noise");
    run(&mut world, 5, OFF, &[]);
    let stuck = codes(&mut world)[Sensor::Check as usize];
    world.set_force_and_faults(
        0.0,
        [of(FaultKind::ThermistorStuck, Sensor::Check, 0.0)].into_iter(),
    );
    let mut display = Vec::new();
    for _ in 0..200 {
        world.step(driven(1.0, 0.5));
        let codes = codes(&mut world);
        assert_eq!(codes[Sensor::Check as usize], stuck);
        display.push(codes[Sensor::Display as usize]);
    }
    display.dedup();
    assert!(display.len() > 50, "it cools: {}", display.len());
}

#[test]
fn stuck_converter_repeats_every_channel() {
    let mut world = World::new(&scene("")).expect("a plant with noise");
    run(&mut world, 5, OFF, &[]);
    let stuck = codes(&mut world);
    for _ in 0..20 {
        run(&mut world, 1, driven(1.0, 0.5), &[FaultKind::AdcStuck.into()]);
        assert_eq!(codes(&mut world), stuck);
    }
}

#[test]
fn swapped_thermistors_read_each_other() {
    let mut world = ideal();
    let hot = broken(FaultKind::SinkHot, 60.0);
    // The sink's thermistor lags by a second; the display is still below 50 C then.
    run(&mut world, 8000, OFF, &[hot]);
    let sound = codes(&mut world);
    assert!(sound[2].abs_diff(AT_60_C) <= 1, "{sound:?}");
    assert!(sound[0] > AT_60_C + 250, "{sound:?}");
    for sensor in [Sensor::Display, Sensor::Check] {
        let swapped =
            ActiveFault { with: Sensor::Sink, ..of(FaultKind::SensorsSwapped, sensor, 0.0) };
        world.set_force_and_faults(0.0, [hot, swapped].into_iter());
        world.step(OFF);
        let [before, after] = [sound, codes(&mut world)];
        for (index, expected) in before.into_iter().enumerate() {
            let expected = match index {
                2 => before[sensor as usize],
                _ if index == sensor as usize => before[2],
                _ => expected,
            };
            assert!(after[index].abs_diff(expected) <= 1, "{sensor:?}: {before:?} {after:?}");
        }
    }
}

#[test]
fn dividers_without_reference_all_read_short() {
    assert_eq!(after(&[FaultKind::ReferenceOff.into()]), [0, 0, 0, 0, 0, 410, 0, 3464]);
}

#[test]
fn force_sensor_breaks_off_sticks_and_shifts() {
    let mut world = ideal();
    let pressed = |world: &mut World, all: &[ActiveFault]| {
        world.set_force_and_faults(2.0, all.iter().copied());
        for _ in 0..20 {
            world.step(OFF);
        }
        codes(world)[Channel::Force as usize]
    };
    // 300 counts/N over 410.
    assert_eq!(pressed(&mut world, &[FaultKind::ForceStuck.into()]), 410);
    assert_eq!(pressed(&mut world, &[]), 1010);
    assert_eq!(pressed(&mut world, &[broken(FaultKind::ForceOffset, -0.5)]), 860);
    assert_eq!(pressed(&mut world, &[FaultKind::ForceOpen.into()]), 0);
    assert_eq!(world.plant().force_n(), 2.0, "the finger presses all the same");
}

/// The loose one lags twenty times as long, 2 s: 63 % of a step are left when the sound one has arrived.
#[test]
fn detached_thermistor_lags() {
    let mut world = ideal();
    let detached = [of(FaultKind::ThermistorDetached, Sensor::Check, 20.0)];
    run(&mut world, 1000, driven(1.0, 0.6), &detached);
    let cooled = codes(&mut world);
    let fell_k = 24.0 - world.plant().display_c();
    assert!(fell_k > 5.0, "{fell_k} K");
    let rose = |sensor: Sensor| f64::from(cooled[sensor as usize] - AT_24_C);
    // Of a ramp of 1 s, a lag of 2 s has passed on 1 - 2 (1 - exp(-1/2)) = 21 %, one of 0.1 s 90 %.
    let share = rose(Sensor::Check) / rose(Sensor::Display);
    assert!((0.2..0.4).contains(&share), "{share}");
}

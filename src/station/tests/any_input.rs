//! What must hold whatever the sensors say and the host wants.

use proptest::prelude::*;
use std::vec::Vec;

use super::Bench;
use crate::drive::{Drive, Duty};
use crate::guard::{Setpoint, State};
use crate::protocol::ANSWER_MAX;
use crate::sense::Samples;

/// A sum of counts: mostly a plausible one, sometimes any.
fn sum(plausible: core::ops::Range<u16>) -> impl Strategy<Value = u16> {
    prop_oneof![30 => plausible, 1 => any::<u16>(), 1 => Just(0), 1 => Just(u16::MAX)]
}

/// 20 to 40 °C, 0 to 3 N, 0 to 6 A.
fn samples() -> impl Strategy<Value = Samples> {
    let temperature = || sum(23_000..36_000);
    let temperatures = (
        temperature(),
        temperature(),
        temperature(),
        temperature(),
        temperature(),
    );
    let rest = (sum(6_560..21_000), sum(0..38_400), prop::bool::weighted(0.02));
    (temperatures, rest).prop_map(
        |((display, display_check, sink, skin, room), (force, current, bridge_fault))| Samples {
            display,
            display_check,
            sink,
            skin,
            room,
            force,
            current,
            bridge_fault,
        },
    )
}

fn line() -> impl Strategy<Value = &'static str> {
    prop::sample::select(
        &[
            "id",
            "state",
            "stream 1",
            "material copper",
            "material foam",
            "material custom 5000 30000 10000 0.01 1.5",
            "material custom 0.01 1 10 1000 0.001",
            "object -20",
            "object 60",
            "object room",
            "mode contact",
            "mode semi-infinite",
            "law model",
            "law pi",
            "law pi-10hz",
            "hold 15",
            "hold 42",
            "tune",
            "tune result",
            "set tile 0.5 0.5 5 5 1",
            "set tile 15 0 0 0.005 0",
            "object -20",
            "material custom 0.37 1 10 0.001 1.5",
            "calibrate display 30",
            "calibrate display clear",
            "set steps 10 4 4 4 4 4 4 4",
            "set correction display -1.2 -0.05 -0.002",
            "arm",
            "start",
            "start",
            "abort",
            "clear",
            "clear",
        ][..],
    )
}

/// Lines, and samples that hold for some ticks.
fn story() -> impl Strategy<Value = Vec<(Vec<&'static str>, Samples, u8)>> {
    let lines = prop::collection::vec(line(), 0..4);
    prop::collection::vec((lines, samples(), 1u8..20), 1..40)
}

/// Sums of display, sink, skin, room and force.
type World = (u16, u16, u16, u16, u16);
/// Lines that are sent, and the world for some ticks after them.
type Phase = (Vec<&'static str>, World, u16);

fn world() -> impl Strategy<Value = World> {
    let temperature = || 23_000u16..36_000;
    let force = prop_oneof![Just(6_560u16), 6_560u16..21_000];
    (temperature(), temperature(), temperature(), temperature(), force)
}

/// Lines, and worlds that last: without a fault, so that the law goes on.
fn long_story() -> impl Strategy<Value = Vec<Phase>> {
    let lines = prop::collection::vec(line(), 0..3);
    prop::collection::vec((lines, world(), 1u16..3000), 1..12)
}

/// One tick, and what must hold in it.
fn step(bench: &mut Bench, samples: &Samples) -> Result<(), TestCaseError> {
    let tripped = matches!(bench.state(), State::Tripped(_));
    let drive = bench.station.step(samples).drive;
    let telemetry = bench.station.telemetry().expect("streamed on every tick");
    let driven = matches!(telemetry.state, State::Armed | State::Preset | State::Contact);
    prop_assert_eq!(driven, drive != Drive::Off);
    prop_assert_eq!(driven, telemetry.setpoint.is_some());
    prop_assert!(!tripped || !driven);
    prop_assert!(!driven || !samples.bridge_fault);
    prop_assert!(driven || telemetry.demand == 0);
    prop_assert!(telemetry.demand.abs() <= 6);
    if let Drive::On(duty) = drive {
        prop_assert!(duty.fraction().abs() <= Duty::LIMIT);
    }
    if let Some(setpoint) = telemetry.setpoint {
        prop_assert!((15.0..=42.0).contains(&setpoint.to_num::<f64>()));
        prop_assert_eq!(Setpoint::limited(setpoint).1, false);
    }
    Ok(())
}

/// Sends a line, and checks what it may change.
fn tell(bench: &mut Bench, line: &str) -> Result<(), TestCaseError> {
    let before = bench.state();
    let answer = bench.host(line);
    prop_assert!(answer.len() <= ANSWER_MAX);
    prop_assert!(line != "abort" || answer == "ok");
    if matches!(before, State::Tripped(_)) && line != "clear" {
        prop_assert_eq!(before, bench.state());
    }
    Ok(())
}

proptest! {
    #[test]
    fn limits_hold_whatever_comes(story in story()) {
        let mut bench = Bench::new();
        bench.obey(&["law model", "material granite", "arm", "start"]);
        for (lines, samples, ticks) in story {
            for line in lines {
                tell(&mut bench, line)?;
            }
            for _ in 0..ticks {
                step(&mut bench, &samples)?;
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn limits_hold_for_long(story in long_story()) {
        let mut bench = Bench::new();
        bench.obey(&["law model", "material copper", "arm", "start"]);
        for (lines, (display, sink, skin, room, force), ticks) in story {
            for line in lines {
                tell(&mut bench, line)?;
            }
            for tick in 0..ticks {
                let samples = Samples {
                    display,
                    display_check: display,
                    sink,
                    skin,
                    room,
                    force,
                    // No converter that stands still.
                    current: tick % 2,
                    bridge_fault: false,
                };
                step(&mut bench, &samples)?;
            }
        }
    }
}

//! What must hold whatever the sensors say and the host wants.

use proptest::prelude::*;
use std::vec::Vec;

use super::Bench;
use crate::drive::{Drive, Duty};
use crate::guard::Setpoint;
use crate::sense::Samples;
use crate::station::State;

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

proptest! {
    #[test]
    fn limits_hold_whatever_comes(story in story()) {
        let mut bench = Bench::new();
        bench.obey(&["material granite", "arm", "start"]);
        for (lines, samples, ticks) in story {
            for line in lines {
                let before = bench.state();
                let answer = bench.host(line);
                prop_assert!(answer.len() <= 160);
                prop_assert!(line != "abort" || answer == "ok");
                if matches!(before, State::Tripped(_)) && line != "clear" {
                    prop_assert_eq!(before, bench.state());
                }
            }
            for _ in 0..ticks {
                let tripped = matches!(bench.state(), State::Tripped(_));
                let drive = bench.station.step(&samples);
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
            }
        }
    }
}

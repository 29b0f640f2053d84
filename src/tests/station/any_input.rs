//! What must hold whatever the sensors say and the host wants.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;
use std::vec::Vec;

use super::Bench;
use crate::device::drive::{Drive, Duty};
use crate::device::safety::{Setpoint, State};
use crate::device::sense::Samples;
use crate::protocol::ANSWER_MAX;

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
    let rest = (
        sum(6_560..21_000),
        sum(0..38_400),
        prop::bool::weighted(0.02),
    );
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

/// Where the world goes, as fast as a world can; lines that are sent before, and samples that come once amid it.
#[derive(Clone, Debug)]
struct Phase {
    lines: Vec<&'static str>,
    display_c: f64,
    sink_c: f64,
    skin_c: f64,
    room_c: f64,
    force_n: f64,
    ticks: u16,
    once: Option<Samples>,
}

fn story(phases: usize, ticks: u16, once: f64) -> impl Strategy<Value = Vec<Phase>> {
    let force = prop_oneof![Just(0.0), 0.0..5.0];
    let world = (16.0..41.0, 15.0..38.0, 28.0..38.0, 18.0..30.0, force);
    let lines = prop::collection::vec(line(), 0..4);
    let once = prop::option::weighted(once, samples());
    let phase = (lines, world, 1..ticks, once).prop_map(
        |(lines, (display_c, sink_c, skin_c, room_c, force_n), ticks, once)| Phase {
            lines,
            display_c,
            sink_c,
            skin_c,
            room_c,
            force_n,
            ticks,
            once,
        },
    );
    prop::collection::vec(phase, 1..phases)
}

/// Ticks, and those in which the bridge was driven.
#[derive(Debug, Default)]
struct Count {
    all: Cell<u32>,
    driven: Cell<u32>,
}

impl Count {
    /// What must hold in one tick, of these samples or of the bench's.
    fn tick(&self, bench: &mut Bench, samples: Option<&Samples>) -> Result<(), TestCaseError> {
        let tripped = bench.station.is_tripped();
        let tested = bench.state() == State::SelfTest;
        let (outputs, telemetry) = match samples {
            Some(samples) => (
                bench.station.step(samples),
                bench.station.telemetry().expect("streamed on every tick"),
            ),
            None => bench.step_all(),
        };
        let on = outputs.drive != Drive::Off;
        let driven = matches!(
            telemetry.state,
            State::Armed | State::Preset | State::Contact
        );
        // In the tick in which the self-test passes, the bridge rests.
        let follows = driven && !tested;
        prop_assert!(follows == on || telemetry.state == State::SelfTest);
        prop_assert_eq!(follows, telemetry.setpoint.is_some());
        prop_assert!(!tripped || !on);
        prop_assert!(!on || samples.is_none_or(|samples| !samples.bridge_fault));
        prop_assert!(on || telemetry.demand == 0);
        prop_assert!(telemetry.demand.abs() <= 6);
        prop_assert!(!(on && outputs.comparator_test));
        if let Drive::On(duty) = outputs.drive {
            prop_assert!(duty.fraction().abs() <= Duty::LIMIT);
        }
        if let Some(setpoint) = telemetry.setpoint {
            prop_assert!((15.0..=42.0).contains(&setpoint.to_num::<f64>()));
            prop_assert_eq!(Setpoint::limited(setpoint).1, false);
        }
        // What the self-test asks for it gets.
        if telemetry.state == State::SelfTest {
            bench.display_c -= 2.7e-3 * telemetry.demand.to_num::<f64>();
            bench.check_c = bench.display_c;
        }
        bench.bridge_fault = outputs.comparator_test;
        self.all.set(self.all.get() + 1);
        self.driven.set(self.driven.get() + u32::from(on));
        Ok(())
    }

    fn phase(&self, bench: &mut Bench, phase: &Phase) -> Result<(), TestCaseError> {
        for line in &phase.lines {
            tell(bench, line)?;
        }
        bench.force_n = phase.force_n;
        for tick in 0..phase.ticks {
            let samples = phase.once.as_ref().filter(|_| tick == phase.ticks / 2);
            self.tick(bench, samples)?;
            if bench.state() == State::SelfTest {
                continue;
            }
            let display_c = if bench.answers {
                bench.display_c
            } else {
                phase.display_c
            };
            for (at_c, to_c) in [
                (&mut bench.display_c, display_c),
                (&mut bench.sink_c, phase.sink_c),
                (&mut bench.skin_c, phase.skin_c),
                (&mut bench.room_c, phase.room_c),
            ] {
                *at_c += (to_c - *at_c).clamp(-0.1, 0.1);
            }
            bench.check_c = bench.display_c;
        }
        Ok(())
    }
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

/// Runs stories; what was driven must be a part that is worth it.
#[track_caller]
fn check(cases: u32, answers: bool, stories: &impl Strategy<Value = Vec<Phase>>) {
    let count = Count::default();
    let mut runner = TestRunner::new(ProptestConfig::with_cases(cases));
    let outcome = runner.run(stories, |story| {
        let mut bench = Bench::new();
        bench.answers = answers;
        bench.obey(&["law model", "material granite", "arm", "start"]);
        story
            .iter()
            .try_for_each(|phase| count.phase(&mut bench, phase))
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let (driven, all) = (count.driven.get(), count.all.get());
    assert!(driven > all / 10, "{driven} of {all} ticks were driven");
}

#[test]
fn limits_hold_whatever_comes() {
    check(64, false, &story(12, 60, 0.3));
}

#[test]
fn limits_hold_for_long() {
    // A display that goes where it likes is none that the model fits for long.
    check(12, true, &story(8, 3000, 0.05));
}

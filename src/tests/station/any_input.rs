//! Safety properties that hold for any samples and any lines from the host.

use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::TestRunner;
use std::cell::Cell;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use contact_model::fixed_point::{FAST_MAX, SLOW_MAX};

use super::TestBench;
use crate::device::StateName;
use crate::device::command::AssumedFinger;
use crate::device::drive::{ComparatorTest, Drive, Duty};
use crate::device::safety::Setpoint;
use crate::device::sense::Samples;
use crate::protocol::ANSWER_MAX_BYTES;
use crate::tests::objects::checksum;

/// A sum of conversions: mostly a plausible one, sometimes any.
fn sum(plausible: core::ops::Range<u16>) -> impl Strategy<Value = u16> {
    prop_oneof![30 => plausible, 1 => any::<u16>(), 1 => Just(0), 1 => Just(u16::MAX)]
}

/// Samples of 20 to 40 °C, 0 to 3 N, 0 to 6 A, and sometimes of any value.
fn samples() -> impl Strategy<Value = Samples> {
    let temperature = || sum(23_000..36_000);
    let temperatures = (temperature(), temperature(), temperature(), temperature(), temperature());
    let others = (
        sum(6_560..21_000),
        sum(0..38_400),
        sum(50_000..60_900),
        prop::bool::weighted(0.02),
        prop::bool::weighted(0.02),
        prop::bool::weighted(0.02),
    );
    (temperatures, others).prop_map(
        |(
            (display, display_check, sink, skin, room),
            (force, current, supply, bridge_fault, emergency_stop, comparator_side_differs),
        )| Samples {
            display,
            display_check,
            sink,
            skin,
            room,
            force,
            current,
            supply,
            bridge_fault,
            emergency_stop,
            comparator_side_differs,
            scattering_thermistors: 5,
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
            "object slab 0.1mm insulated",
            "object slab 30 mm film 100",
            "object half-space",
            "finger mean",
            "contact",
            "contact nominal",
            "contact 0.3 1000 100000",
            "contact 1.5 100000000 0",
            "finger thesis",
            "upload begin object 1 0.5",
            "upload row 0 2 40",
            "upload commit 21a54dda",
            "mode contact",
            "mode semi-infinite",
            "law model",
            "law pi",
            "law pi-10hz",
            "hold 15",
            "hold 42",
            "tune",
            "tune result",
            "flux set 1 64 500 1000",
            "flux",
            "flux zero",
            "flux none",
            "set flux 0.01 4031 0.1 0",
            "surface",
            "surface set 0.1 0.01 1.5",
            "set surface 500 30 0.001",
            "surface nominal",
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

/// The whole upload of an object at an end of what is allowed, or anywhere between: rates and gains that make the device's
/// relaxations as many, as fast, as slow and as large as they may be.
fn upload() -> impl Strategy<Value = Vec<String>> {
    let fast_1_s = prop_oneof![Just(690.0), Just(12.6), 12.6..690.0];
    let slow_1_s = prop_oneof![Just(0.0), Just(12.4), 1e-6..12.4];
    let rates_1_s = (
        prop::collection::vec(fast_1_s, 0..=FAST_MAX),
        prop::collection::vec(slow_1_s, 0..=SLOW_MAX),
    );
    // All gains together, mm² K/J, and the direct term, mm² K/W.
    let decades = prop_oneof![Just(7.1), -3.0..7.1f64];
    let direct = prop_oneof![Just(0.0), Just(27_000.0), 0.0..27_000.0];
    (rates_1_s, decades, direct).prop_map(|((fast, slow), decades, direct)| {
        let rates_1_s = [fast, slow].concat();
        let gain = 10f64.powf(decades) / rates_1_s.len().max(1) as f64;
        let mut lines = Vec::from([format!("upload begin object {} {direct:.6}", rates_1_s.len())]);
        let rows = rates_1_s.iter().enumerate();
        lines.extend(rows.map(|(i, rate)| format!("upload row {i} {rate:.6} {gain:.6}")));
        lines.push(format!("upload commit {:08x}", checksum(&lines)));
        lines
    })
}

/// Lines that are sent first; targets that the physical quantities then approach at 0.1 K a tick; samples of one tick
/// in the middle, with their probability in [`scenario`].
#[derive(Clone, Debug)]
struct Phase {
    lines: Vec<String>,
    display_c: f64,
    sink_c: f64,
    skin_c: f64,
    room_c: f64,
    force_n: f64,
    ticks: u16,
    outlier: Option<Samples>,
}

fn scenario(phases: usize, ticks: u16, outlier: f64) -> impl Strategy<Value = Vec<Phase>> {
    let force = prop_oneof![Just(0.0), 0.0..5.0];
    let quantities = (16.0..41.0, 15.0..38.0, 28.0..38.0, 18.0..30.0, force);
    let line = line().prop_map(|line| Vec::from([line.to_string()]));
    let lines = prop::collection::vec(prop_oneof![6 => line, 1 => upload()], 0..4);
    let lines = lines.prop_map(|lines| lines.concat());
    let outlier = prop::option::weighted(outlier, samples());
    let phase = (lines, quantities, 1..ticks, outlier).prop_map(
        |(lines, (display_c, sink_c, skin_c, room_c, force_n), ticks, outlier)| Phase {
            lines,
            display_c,
            sink_c,
            skin_c,
            room_c,
            force_n,
            ticks,
            outlier,
        },
    );
    prop::collection::vec(phase, 1..phases)
}

/// Number of ticks, and of those in which the bridge was driven.
#[derive(Debug, Default)]
struct TickCount {
    all: Cell<u32>,
    driven: Cell<u32>,
}

impl TickCount {
    /// Advances by one tick, with these samples or those of the bench, and checks what must hold.
    fn tick(&self, bench: &mut TestBench, samples: Option<&Samples>) -> Result<(), TestCaseError> {
        let tripped = bench.station.is_tripped();
        let was_testing = bench.state() == StateName::SelfTest;
        let (outputs, telemetry) = match samples {
            Some(samples) => (
                bench.station.step(samples),
                bench.station.telemetry_if_due().expect("streamed on every tick"),
            ),
            None => bench.step_with_outputs(),
        };
        let on = outputs.drive != Drive::Off;
        let driven = matches!(
            telemetry.state,
            StateName::Armed | StateName::Preset | StateName::Contact | StateName::Stimulus
        );
        // The bridge stays off in the tick in which the self-test passes.
        let controls = driven && !was_testing;
        prop_assert!(controls == on || telemetry.state == StateName::SelfTest);
        prop_assert_eq!(controls, telemetry.setpoint.is_some());
        prop_assert!(!tripped || !on);
        let forbidden = |samples: &Samples| samples.bridge_fault || samples.emergency_stop;
        prop_assert!(!on || !samples.is_some_and(forbidden));
        prop_assert!(on || telemetry.demand == 0);
        prop_assert!(telemetry.demand.abs() <= 6);
        prop_assert!(!on || outputs.comparator_test == ComparatorTest::None);
        if let Drive::On(duty) = outputs.drive {
            prop_assert!(duty.fraction().abs() <= Duty::DUTY_LIMIT);
        }
        if let Some(setpoint) = telemetry.setpoint {
            prop_assert!((15.0..=42.0).contains(&setpoint.to_num::<f64>()));
            prop_assert_eq!(Setpoint::clamp_celsius_with_flag(setpoint).1, false);
        }
        // The display responds to the self-test.
        if telemetry.state == StateName::SelfTest {
            bench.display_c -= 2.7e-3 * telemetry.demand.to_num::<f64>();
            bench.check_c = bench.display_c;
        }
        bench.apply_comparator_test(outputs.comparator_test);
        self.all.set(self.all.get() + 1);
        self.driven.set(self.driven.get() + u32::from(on));
        Ok(())
    }

    fn phase(&self, bench: &mut TestBench, phase: &Phase) -> Result<(), TestCaseError> {
        for line in &phase.lines {
            send(bench, line)?;
        }
        bench.force_n = phase.force_n;
        for tick in 0..phase.ticks {
            let samples = phase.outlier.as_ref().filter(|_| tick == phase.ticks / 2);
            self.tick(bench, samples)?;
            if bench.state() == StateName::SelfTest {
                continue;
            }
            let display_c = if bench.plate_responds { bench.display_c } else { phase.display_c };
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

/// Sends a line, and checks its answer and the state.
fn send(bench: &mut TestBench, line: &str) -> Result<(), TestCaseError> {
    let before = bench.state();
    let answer = bench.send(line);
    prop_assert!(answer.len() <= ANSWER_MAX_BYTES);
    prop_assert!(line != "abort" || answer == "ok");
    if matches!(before, StateName::Tripped(_)) && line != "clear" {
        prop_assert_eq!(before, bench.state());
    }
    Ok(())
}

/// Runs scenarios, and asserts that the bridge was driven in more than a tenth of the ticks.
#[track_caller]
fn check(cases: u32, plate_responds: bool, scenarios: &impl Strategy<Value = Vec<Phase>>) {
    let count = TickCount::default();
    let mut runner = TestRunner::new(ProptestConfig::with_cases(cases));
    let outcome = runner.run(scenarios, |scenario| {
        let mut bench = TestBench::new();
        bench.plate_responds = plate_responds;
        bench.send_ok(&["law model", "material granite", "arm", "start"]);
        scenario.iter().try_for_each(|phase| count.phase(&mut bench, phase))
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let (driven, all) = (count.driven.get(), count.all.get());
    assert!(driven > all / 10, "{driven} of {all} ticks were driven");
}

#[test]
fn safety_limits_hold_for_any_samples_and_lines() {
    check(64, false, &scenario(12, 60, 0.3));
}

#[test]
fn safety_limits_hold_for_any_object_under_a_finger() {
    let (accepted, sent) = (Cell::new(0), Cell::new(0));
    let temperatures = prop_oneof![Just(-20.0), Just(60.0), -20.0..60.0];
    let scenarios = (upload(), temperatures, 0.05..5.0, select(AssumedFinger::ALL));
    let count = TickCount::default();
    let mut runner = TestRunner::new(ProptestConfig::with_cases(48));
    let outcome = runner.run(&scenarios, |(upload, object_c, force_n, finger)| {
        let mut bench = TestBench::new();
        bench.plate_responds = true;
        send(&mut bench, &format!("finger {}", finger.name()))?;
        bench.send_ok(&["law model", "material granite", "arm", "start"]);
        send(&mut bench, &format!("object {object_c}"))?;
        sent.set(sent.get() + 1);
        let taken = upload.iter().all(|line| bench.send(line) == "ok");
        accepted.set(accepted.get() + u32::from(taken));
        for (force_n, ticks) in [(0.0, 50), (force_n, 1500), (0.0, 200), (5.0, 800)] {
            bench.force_n = force_n;
            for _ in 0..ticks {
                count.tick(&mut bench, None)?;
            }
        }
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let (driven, all) = (count.driven.get(), count.all.get());
    assert!(driven > all / 2, "{driven} of {all} ticks were driven");
    let (accepted, sent) = (accepted.get(), sent.get());
    assert!(accepted > sent / 2, "{accepted} of {sent} uploads");
}

#[test]
fn safety_limits_hold_in_long_scenarios() {
    // The plate responds to the current: a display that moves independently trips the model's residual soon.
    check(12, true, &scenario(8, 3000, 0.05));
}

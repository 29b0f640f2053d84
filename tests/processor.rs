//! What becomes of the bridge when the processor itself fails.

use hil_sim::World;
use hil_sim::engine::{Image, MachineFault, Native, NotInjected};
use hil_sim::machine::{Firmware, ResetCause};
use hil_sim::run::{Injection, Outcome, RunError, run, run_with};
use hil_sim::scene::Scene;
use system_tests::{between, forces, host, image, on_image, scene};

/// Copper under 2 N from 0.5 s on.
fn copper() -> Scene {
    scene("copper", 2.0, "", &forces(&[(0.5, 2.0)]))
}

fn failing(t_s: f64, fault: &str) -> Outcome {
    let (scene, firmware) = (copper(), Firmware::from_file(image()).expect("an image"));
    let world = World::new(&scene).expect("a plant for the scene");
    let mut engine = Image::new(&firmware, world).expect("the image samples");
    let fault = fault.parse().expect("a fault");
    run_with(&scene, &[Injection { t_s, fault }], &mut engine, |_| ())
        .expect("the image runs to the end")
}

/// The timer goes on with the last duty until then: 100 ms at most with the nominal oscillator of the slower watchdog.
#[test]
fn a_hung_core_ends_in_a_watchdog_reset_that_takes_the_bridge_off() {
    let outcome = failing(1.0, "hung-core");
    let [reset] = outcome.resets[..] else {
        panic!("{:?}", outcome.resets)
    };
    assert!(
        matches!(
            reset.cause,
            ResetCause::WindowWatchdog | ResetCause::IndependentWatchdog
        ),
        "{reset:?}"
    );
    assert!((1.0..1.102).contains(&reset.t_s), "{reset:?}");
    for row in between(&outcome, 1.0, reset.t_s) {
        assert!(
            row.current_a.abs() > 0.3,
            "{} A at {} s",
            row.current_a,
            row.t_s
        );
    }
    // The plant sees the legs at its next boundary.
    for row in between(&outcome, reset.t_s + 2e-3, 2.0) {
        assert_eq!(row.current_a, 0.0, "at {} s", row.t_s);
    }
}

#[test]
fn resets_from_outside_take_the_bridge_off_and_are_reported() {
    for (fault, cause) in [
        ("reset-pin", ResetCause::Pin),
        ("brown-out", ResetCause::BrownOut),
        ("power-cycle=3", ResetCause::PowerOn),
        ("software-reset", ResetCause::Software),
    ] {
        let outcome = failing(1.0, fault);
        let [reset] = outcome.resets[..] else {
            panic!("{:?}", outcome.resets)
        };
        assert_eq!(reset.cause, cause);
        assert!((reset.t_s - 1.0).abs() < 1e-6, "{reset:?}");
        for row in between(&outcome, 1.0015, 2.0) {
            assert_eq!(row.current_a, 0.0, "{fault}, at {} s", row.t_s);
        }
    }
}

/// The last `state` that the device has told.
fn told_state(outcome: &Outcome) -> &str {
    let mut states = outcome.answers.iter().rev().map(|(_, line)| line.as_str());
    let state = states.find(|line| line.starts_with("ok state="));
    state.expect("an answer to `state`")
}

#[test]
fn a_reset_that_was_asked_for_is_no_fault_and_another_one_is() {
    let lines = host(&[(0.2, "abort"), (0.4, "save"), (1.8, "state")]);
    let planned = on_image(&scene("copper", 2.0, "", &(lines + &forces(&[(0.5, 2.0)]))));
    assert_eq!(planned.resets[0].cause, ResetCause::Software);
    assert!(
        told_state(&planned).starts_with("ok state=off fault=- "),
        "{}",
        told_state(&planned)
    );

    let lines = "[[fault]]\nkind = \"software-reset\"\nt_s = 0.5\n".to_owned();
    let lines = lines + &host(&[(1.7, "state"), (1.8, "state")]);
    let unasked = on_image(&scene("copper", 2.0, "", &(lines + &forces(&[(0.5, 2.0)]))));
    let state = told_state(&unasked);
    assert!(
        state.starts_with("ok state=tripped fault=unasked-reset "),
        "{state}"
    );
}

#[test]
fn what_fails_does_so_at_its_microsecond() {
    for t_s in [1.0, 1.000_25, 1.000_5, 1.000_731] {
        let resets = failing(t_s, "reset-pin").resets;
        assert!(
            matches!(resets[..], [reset] if (reset.t_s - t_s).abs() < 1e-6),
            "{t_s} s: {resets:?}"
        );
    }
}

#[test]
fn a_flip_of_memory_that_nothing_uses_changes_nothing() {
    let (whole, flipped) = (on_image(&copper()), failing(1.0, "ram-bit=0x20000100.0"));
    assert!(whole.resets.is_empty() && flipped.resets.is_empty());
    assert_eq!(whole.trace.rows(), flipped.trace.rows());
}

#[test]
fn the_native_engine_says_what_it_has_no_part_for() {
    let scene = copper();
    let native = || Native::new(World::new(&scene).expect("a plant for the scene"));
    let with = |fault, t_s| run_with(&scene, &[Injection { t_s, fault }], &mut native(), |_| ());
    assert!(matches!(
        with(MachineFault::HseStopped, 1.0),
        Err(RunError::NotInjected(NotInjected::NotApplicable {
            fault: MachineFault::HseStopped,
            engine: "native"
        }))
    ));
    assert!(matches!(
        with(MachineFault::ResetPin, 2.5),
        Err(RunError::InjectionTime { .. })
    ));
    // No tick: the last duty, until the window watchdog's time is over.
    for fault in [MachineFault::HungCore, MachineFault::AdcStopped] {
        let hung = with(fault, 1.0).expect("runs");
        let causes: Vec<_> = hung.resets.iter().map(|reset| reset.cause).collect();
        assert_eq!(causes, [ResetCause::WindowWatchdog]);
        let at = |t_s: f64| between(&hung, t_s, 2.0).next().map(|row| row.current_a);
        assert!(at(1.04).is_some_and(|a| a.abs() > 0.3));
        assert_eq!(at(1.05), Some(0.0));
    }
    let whole = run(&scene, &mut native(), |_| ()).expect("runs");
    assert!(whole.resets.is_empty());
}

//! The bridge when the processor fails or is reset, on the release image.

use image_tests::{image, on_image};
use stm32_emulator::Firmware;
use stm32_emulator::OneFingerBoard;
use system_tests::{between, copper_contact, forces, host, scene};
use thermal_campaigns::faults::{
    FaultCase, FaultRun, FaultScene, InjectionPoint, RunAssessment, fault_cases,
};
use thermal_sim::World;
use thermal_sim::processor::Injection;
use thermal_sim::processor::ResetCause;
use thermal_sim::run::{Outcome, run_with};

/// Runs a contact with copper and injects a fault.
fn with_fault(t_s: f64, fault: &str) -> Outcome {
    let (scene, firmware) = (copper_contact(), Firmware::from_file(image()).expect("an image"));
    let world = World::new(&scene).expect("a plant for the scene");
    let mut engine = OneFingerBoard::new(&firmware, world).expect("the image samples");
    let fault = fault.parse().expect("a fault");
    run_with(&scene, &[Injection { t_s, fault }], &mut engine, |_| ())
        .expect("the image runs to the end")
}

/// The converter of the heat-flux sensor ends no conversion any more, in a contact with copper that has been learnt: the device
/// says so, does not trip, and renders the assumed finger.
#[test]
fn a_stopped_converter_of_the_flux_is_a_word_and_ends_in_the_assumed_finger() {
    let image = Firmware::from_file(image()).expect("an image");
    let stopped = |case: &FaultCase| case.fault.to_string() == "adc2-stopped";
    let case = fault_cases().into_iter().find(stopped).expect("a row");
    let scene = FaultScene::Copper;
    let run = FaultRun::run(&image, &case, InjectionPoint { scene, t_s: 2.0 }, 1);
    let run = run.expect("the image runs").expect("an injected fault");
    let RunAssessment { breaches, knowledge, .. } = run.assessment;
    assert_eq!((breaches, knowledge.as_deref()), (vec![], Some("no-code")));
}

/// The timer keeps the last duty until the reset: 100 ms at most with the nominal oscillator of the slower watchdog.
#[test]
fn a_hung_core_ends_in_a_watchdog_reset_that_switches_the_bridge_off() {
    let outcome = with_fault(1.0, "hung-core");
    let [reset] = outcome.resets[..] else { panic!("{:?}", outcome.resets) };
    assert!(
        matches!(reset.cause, ResetCause::WindowWatchdog | ResetCause::IndependentWatchdog),
        "{reset:?}"
    );
    assert!((1.0..1.102).contains(&reset.t_s), "{reset:?}");
    for row in between(&outcome, 1.0, reset.t_s) {
        assert!(row.current_a.abs() > 0.3, "{} A at {} s", row.current_a, row.t_s);
    }
    // The plant takes the legs' state at its next boundary.
    for row in between(&outcome, reset.t_s + 2e-3, 2.0) {
        assert_eq!(row.current_a, 0.0, "at {} s", row.t_s);
    }
}

#[test]
fn each_reset_switches_the_bridge_off_and_is_reported_with_its_cause() {
    for (fault, cause) in [
        ("reset-pin", ResetCause::Pin),
        ("brown-out", ResetCause::BrownOut),
        ("power-cycle=3", ResetCause::PowerOn),
        ("software-reset", ResetCause::Software),
    ] {
        let outcome = with_fault(1.0, fault);
        let [reset] = outcome.resets[..] else { panic!("{:?}", outcome.resets) };
        assert_eq!(reset.cause, cause);
        assert!((reset.t_s - 1.0).abs() < 1e-6, "{reset:?}");
        for row in between(&outcome, 1.0015, 2.0) {
            assert_eq!(row.current_a, 0.0, "{fault}, at {} s", row.t_s);
        }
    }
}

/// The last answer to `state`.
fn last_state(outcome: &Outcome) -> &str {
    let mut states = outcome.answers.iter().rev().map(|(_, line)| line.as_str());
    let state = states.find(|line| line.starts_with("ok state="));
    state.expect("an answer to `state`")
}

#[test]
fn a_software_reset_is_a_fault_unless_a_save_caused_it() {
    let lines = host(&[(0.2, "abort"), (0.4, "save"), (1.8, "state")]);
    let planned = on_image(&scene("copper", 2.0, "", &(lines + &forces(&[(0.5, 2.0)]))));
    assert_eq!(planned.resets[0].cause, ResetCause::Software);
    assert!(last_state(&planned).starts_with("ok state=off fault=- "), "{}", last_state(&planned));

    let lines = "[[fault]]\nkind = \"software-reset\"\nt_s = 0.5\n".to_owned();
    let lines = lines + &host(&[(1.7, "state"), (1.8, "state")]);
    let unasked = on_image(&scene("copper", 2.0, "", &(lines + &forces(&[(0.5, 2.0)]))));
    let state = last_state(&unasked);
    assert!(state.starts_with("ok state=tripped fault=unasked-reset "), "{state}");
}

#[test]
fn a_fault_is_injected_within_a_microsecond_of_its_time() {
    for t_s in [1.0, 1.000_25, 1.000_5, 1.000_731] {
        let resets = with_fault(t_s, "reset-pin").resets;
        assert!(
            matches!(resets[..], [reset] if (reset.t_s - t_s).abs() < 1e-6),
            "{t_s} s: {resets:?}"
        );
    }
}

#[test]
fn a_flipped_bit_in_unused_memory_changes_nothing() {
    let (whole, flipped) = (on_image(&copper_contact()), with_fault(1.0, "ram-bit=0x20000100.0"));
    assert!(whole.resets.is_empty() && flipped.resets.is_empty());
    assert_eq!(whole.trace.rows(), flipped.trace.rows());
}

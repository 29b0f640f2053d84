//! The fault-injection matrix: that its list leaves nothing out, and that its verdicts can be bad.

use std::collections::HashSet;

use thermal_campaigns::faults::{
    Breach, ExpectedReaction, FaultCase, FaultRun, FaultScene, InjectedFault, LearningExpected,
    Symptom, fault_cases, five_finger_cases,
};
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_sim::NativeRunner;
use thermal_sim::scene::{FaultKind, ProcessorKind};

const FOAM: FaultScene = FaultScene::Foam;

fn fault_case(name: &str) -> FaultCase {
    let found = fault_cases().into_iter().find(|fault_case| fault_case.fault.to_string() == name);
    found.unwrap_or_else(|| panic!("no fault case {name}"))
}

fn breaches(fault_case: &FaultCase, t_s: f64) -> Vec<Breach> {
    let point = thermal_campaigns::faults::InjectionPoint { scene: FOAM, t_s };
    let trial = FaultRun::run(&NativeRunner, fault_case, point, 1).expect("runs");
    trial.expect("means something natively").assessment.breaches
}

#[test]
fn every_kind_of_fault_has_an_entry_of_its_own() {
    let fault_cases = fault_cases();
    // The faults of the select lines are of the device for five fingers only.
    let kinds: HashSet<_> = fault_cases
        .iter()
        .chain(&five_finger_cases())
        .map(|fault_case| fault_case.fault.kind())
        .collect();
    for kind in FaultKind::ALL.map(FaultKind::name) {
        assert!(kinds.contains(kind), "{kind}");
    }
    for kind in ProcessorKind::ALL {
        assert!(kinds.contains(kind.name), "{}", kind.name);
    }
    let names: HashSet<_> =
        fault_cases.iter().map(|fault_case| fault_case.fault.to_string()).collect();
    assert_eq!(names.len(), fault_cases.len());
}

/// What the guard can name is the right answer to something, but for what cannot be injected: settings that are stored
/// wrong, force samples that repeat themselves, and option bytes, which a start reads (see the tests of the chip).
#[test]
fn every_reason_of_the_guard_is_right_for_an_entry() {
    let fault_cases: Vec<_> = fault_cases().into_iter().chain(five_finger_cases()).collect();
    let right: Vec<Fault> = fault_cases
        .iter()
        .filter_map(|fault_case| match fault_case.expected {
            ExpectedReaction::Trip(faults) => Some(faults),
            ExpectedReaction::Restart => None,
        })
        .flatten()
        .copied()
        .collect();
    let left: Vec<_> = Fault::ALL.iter().filter(|fault| !right.contains(fault)).collect();
    assert_eq!(left, [&Fault::ForceFrozen, &Fault::BrownOutLevel, &Fault::SettingsCorrupt]);
}

#[test]
fn open_thermistor_holds_and_is_told_from_another() {
    let open = fault_case("thermistor-open display");
    assert_eq!(breaches(&open, 2.0), []);
    let other = FaultCase { expected: ExpectedReaction::Trip(&[Fault::CheckOpen]), ..open };
    assert_eq!(breaches(&other, 2.0), [Breach::Reason]);
    let silent = FaultCase { symptoms: &[], expected: ExpectedReaction::Trip(&[]), ..open };
    assert_eq!(breaches(&silent, 2.0), [Breach::Reason]);
}

/// A drift shows after 3 s; if a case states that it shows at once, the device counts as late.
#[test]
fn device_that_is_slower_than_its_sign_is_late() {
    let drift = fault_case("thermistor-drift display +5 K");
    assert_eq!(breaches(&drift, 2.0), []);
    let at_once = FaultCase { symptoms: &[Symptom::Injection], ..drift };
    assert_eq!(breaches(&at_once, 2.0), [Breach::Late]);
}

/// A fault without a detector, stated as detectable: current continues to flow.
#[test]
fn device_that_goes_on_is_late_and_has_no_reason() {
    let unseen = FaultCase {
        symptoms: &[Symptom::Injection],
        expected: ExpectedReaction::Trip(&[Fault::Comparator]),
        ..fault_case("comparator-dead")
    };
    assert_eq!(breaches(&unseen, 2.0), [Breach::Late, Breach::Reason]);
}

/// A sensor without its plug: another word would be wrong, and the skin is not the same to the last bit.
#[test]
fn a_wrong_word_and_another_skin_are_breaches() {
    let open = fault_case("flux-open");
    assert_eq!(breaches(&open, 2.0), []);
    let learning = open.learning.expect("a row with a sensor");
    let with = |learning| FaultCase { learning: Some(learning), ..open };
    let other_word = LearningExpected { knowledge: &[FingerKnowledge::Late], ..learning };
    assert_eq!(breaches(&with(other_word), 2.0), [Breach::Knowledge]);
    let same_skin = LearningExpected { skin_max_k: 0.0, ..learning };
    assert_eq!(breaches(&with(same_skin), 2.0), [Breach::Changed]);
}

/// A sink that is held at 80 °C reaches the finger whatever the device does.
#[test]
fn skin_and_dose_are_held_to_their_limits() {
    let InjectedFault::Hardware(mut broken) = fault_case("sink-hot 45 °C").fault else {
        panic!("a fault of the plant")
    };
    broken.value = 80.0;
    let hot = FaultCase { fault: InjectedFault::Hardware(broken), ..fault_case("sink-hot 45 °C") };
    assert_eq!(breaches(&hot, 2.0), [Breach::Skin, Breach::Dose]);
}

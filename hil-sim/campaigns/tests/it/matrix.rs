//! The fault-injection matrix: that its list leaves nothing out, and that its verdicts can be bad.

use std::collections::HashSet;

use thermal_campaigns::faults::{Breach, Entry, Injected, Place, Right, Sign, Trial, entries};
use thermal_display::guard::Fault;
use thermal_sim::NativeDevice;
use thermal_sim::scene::{FaultKind, ProcessorKind};

const FOAM: Place = Place::Foam;

fn entry(name: &str) -> Entry {
    let found = entries()
        .into_iter()
        .find(|entry| entry.fault.to_string() == name);
    found.unwrap_or_else(|| panic!("no entry {name}"))
}

fn breaches(entry: &Entry, t_s: f64) -> Vec<Breach> {
    let moment = thermal_campaigns::faults::Moment { place: FOAM, t_s };
    let trial = Trial::run(&NativeDevice, entry, moment, 1).expect("runs");
    trial.expect("means something natively").verdict.breaches
}

#[test]
fn every_kind_of_fault_has_an_entry_of_its_own() {
    let entries = entries();
    let kinds: HashSet<_> = entries.iter().map(|entry| entry.fault.kind()).collect();
    for kind in FaultKind::ALL.map(FaultKind::name) {
        assert!(kinds.contains(kind), "{kind}");
    }
    for kind in ProcessorKind::ALL {
        assert!(kinds.contains(kind.name), "{}", kind.name);
    }
    let names: HashSet<_> = entries
        .iter()
        .map(|entry| entry.fault.to_string())
        .collect();
    assert_eq!(names.len(), entries.len());
}

/// What the guard can name is the right answer to something, but for what cannot be injected: settings that are stored
/// wrong, and force samples that repeat themselves.
#[test]
fn every_reason_of_the_guard_is_right_for_an_entry() {
    let entries = entries();
    let right: Vec<Fault> = entries
        .iter()
        .filter_map(|entry| match entry.right {
            Right::Trip(faults) => Some(faults),
            Right::Restart => None,
        })
        .flatten()
        .copied()
        .collect();
    let left: Vec<_> = Fault::ALL
        .iter()
        .filter(|fault| !right.contains(fault))
        .collect();
    assert_eq!(left, [&Fault::ForceFrozen, &Fault::SettingsCorrupt]);
}

#[test]
fn open_thermistor_holds_and_is_told_from_another() {
    let open = entry("thermistor-open display");
    assert_eq!(breaches(&open, 2.0), []);
    let other = Entry {
        right: Right::Trip(&[Fault::CheckOpen]),
        ..open
    };
    assert_eq!(breaches(&other, 2.0), [Breach::Reason]);
    let silent = Entry {
        signs: &[],
        right: Right::Trip(&[]),
        ..open
    };
    assert_eq!(breaches(&silent, 2.0), [Breach::Reason]);
}

/// A drift shows after 3 s; whoever says that it shows at once finds the device late.
#[test]
fn device_that_is_slower_than_its_sign_is_late() {
    let drift = entry("thermistor-drift display +5 K");
    assert_eq!(breaches(&drift, 2.0), []);
    let at_once = Entry {
        signs: &[Sign::Injection],
        ..drift
    };
    assert_eq!(breaches(&at_once, 2.0), [Breach::Late]);
}

/// A fault that nobody sees, said to be seen: current flows on.
#[test]
fn device_that_goes_on_is_late_and_has_no_reason() {
    let unseen = Entry {
        signs: &[Sign::Injection],
        right: Right::Trip(&[Fault::Comparator]),
        ..entry("comparator-dead")
    };
    assert_eq!(breaches(&unseen, 2.0), [Breach::Late, Breach::Reason]);
}

/// A sink that is held at 80 °C reaches the finger whatever the device does.
#[test]
fn skin_and_dose_are_held_to_their_limits() {
    let Injected::Broken(mut broken) = entry("sink-hot 45 °C").fault else {
        panic!("a fault of the plant")
    };
    broken.value = 80.0;
    let hot = Entry {
        fault: Injected::Broken(broken),
        ..entry("sink-hot 45 °C")
    };
    assert_eq!(breaches(&hot, 2.0), [Breach::Skin, Breach::Dose]);
}

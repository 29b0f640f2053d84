//! Kinds of faults, their names, values and times.

use std::collections::HashSet;

use thermal_sim::scene::{ActiveFault, FaultKind, ScheduledFault};

#[test]
fn every_kind_has_its_own_name() {
    let names: HashSet<_> = FaultKind::ALL.map(FaultKind::name).into();
    assert_eq!(names.len(), FaultKind::ALL.len());
}

#[test]
fn default_values_are_within_their_ranges() {
    for kind in FaultKind::ALL {
        let Some(value) = kind.value() else { continue };
        assert!(value.min < value.max, "{kind:?}");
        let default = value.default.unwrap_or(value.min);
        assert!((value.min..=value.max).contains(&default), "{kind:?}");
    }
}

#[test]
fn fault_is_present_from_its_start_until_its_end() {
    let fault = ScheduledFault { fault: FaultKind::ThermistorOpen.into(), t_s: 1.0, until_s: 2.0 };
    for (t_s, expected) in [(0.999, false), (1.0, true), (1.999, true), (2.0, false)] {
        assert_eq!(fault.at(t_s).is_some(), expected, "{t_s} s");
    }
    let permanent = ScheduledFault { until_s: f64::INFINITY, ..fault };
    assert!(permanent.at(86_400.0).is_some());
}

/// In both directions, from the start of the fault up to its value.
#[test]
fn drift_grows_by_1_kelvin_per_second() {
    for value in [5.0, -5.0] {
        let drift = ActiveFault { value, ..FaultKind::ThermistorDrift.into() };
        let fault = ScheduledFault { fault: drift, t_s: 2.0, until_s: f64::INFINITY };
        for (t_s, expected_k) in [(2.0, 0.0), (3.5, 1.5), (7.0, 5.0), (100.0, 5.0)] {
            let drifted_k = fault.at(t_s).map(|fault| fault.value);
            assert_eq!(drifted_k, Some(value.signum() * expected_k), "{t_s} s");
        }
    }
}

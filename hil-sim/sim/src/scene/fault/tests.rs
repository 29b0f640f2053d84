use std::collections::HashSet;

use super::*;

#[test]
fn names_tell_all_kinds_apart() {
    let names: HashSet<_> = FaultKind::ALL.map(FaultKind::name).into();
    assert_eq!(names.len(), FaultKind::ALL.len());
}

#[test]
fn what_a_scene_means_that_gives_no_value_is_allowed() {
    for kind in FaultKind::ALL {
        let Some(value) = kind.value() else { continue };
        assert!(value.min < value.max, "{kind:?}");
        let meant = value.default.unwrap_or(value.min);
        assert!((value.min..=value.max).contains(&meant), "{kind:?}");
    }
}

#[test]
fn fault_begins_and_ends_at_its_times() {
    let fault = Fault {
        broken: FaultKind::ThermistorOpen.into(),
        t_s: 1.0,
        until_s: 2.0,
    };
    for (t_s, expected) in [(0.999, false), (1.0, true), (1.999, true), (2.0, false)] {
        assert_eq!(fault.at(t_s).is_some(), expected, "{t_s} s");
    }
    let stays = Fault {
        until_s: f64::INFINITY,
        ..fault
    };
    assert!(stays.at(86_400.0).is_some());
}

/// 1 K/s from its begin on, towards either side, up to its value.
#[test]
fn drift_goes_a_kelvin_a_second() {
    for value in [5.0, -5.0] {
        let broken = ActiveFault {
            value,
            ..FaultKind::ThermistorDrift.into()
        };
        let fault = Fault {
            broken,
            t_s: 2.0,
            until_s: f64::INFINITY,
        };
        for (t_s, expected_k) in [(2.0, 0.0), (3.5, 1.5), (7.0, 5.0), (100.0, 5.0)] {
            let drifted_k = fault.at(t_s).map(|broken| broken.value);
            assert_eq!(drifted_k, Some(value.signum() * expected_k), "{t_s} s");
        }
    }
}

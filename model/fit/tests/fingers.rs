//! The committed fingers are those that the fit gives.

use contact_model::finger::{FingerProperties, MEAN, THESIS};
use relaxation_fit::{Fit, fingers};

fn assert_same(committed: &FingerProperties, fit: &Fit) {
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs();
    let (ours, fitted) = (&committed.impedance, fit.impedance());
    assert!(close(ours.direct_m2k_w, fitted.direct_m2k_w));
    assert_eq!(ours.relaxations.len(), fitted.relaxations.len());
    for (ours, fitted) in ours.relaxations.iter().zip(fitted.relaxations) {
        assert!(close(ours.rate_1_s, fitted.rate_1_s), "{ours:?}, not {fitted:?}");
        assert!(close(ours.gain_m2k_j, fitted.gain_m2k_j), "{ours:?}, not {fitted:?}");
    }
}

#[test]
fn committed_fingers_are_those_of_the_fit() {
    assert_same(&THESIS, &fingers::thesis());
    assert_same(&MEAN, &fingers::mean());
}

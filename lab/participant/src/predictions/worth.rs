//! What an error of the skin's temperature is worth in per cent correct.

use super::closed_form::colder;
use super::report::{Falls, Worth};
use crate::ObserverParams;

/// Per cent of trials in which the colder of two stimuli is found, one of which falls by `fall_k` and the other by an error, mK,
/// more.
pub(super) fn percent_correct(observer: &ObserverParams, fall_k: f64, error_mk: f64) -> f64 {
    100.0 * colder(observer, [fall_k + 1e-3 * error_mk, fall_k])
}

/// What errors of 20, 50, 100 and 200 mK at the receptors are worth.
pub(super) fn worth(touch: &ObserverParams, falls: &Falls) -> Vec<Worth> {
    /// Standard normal deviate of 75 %.
    const Z_75: f64 = 0.674_489_750_196_082;
    let of = |name: &str, observer: &ObserverParams, fall_k: f64| Worth {
        observer: name.into(),
        fall_k,
        correct: [20.0, 50.0, 100.0, 200.0]
            .map(|mk| (mk, percent_correct(observer, fall_k, mk)))
            .to_vec(),
        threshold_75_k: Z_75 * std::f64::consts::SQRT_2 * observer.sigma_k(fall_k),
    };
    let mut rows: Vec<Worth> = ["foam", "abs", "granite", "copper"]
        .iter()
        .map(|name| of(&format!("touch of {name}"), touch, falls.of(name)))
        .collect();
    rows.push(of("thermode, fingertip", &ObserverParams::THERMODE_FINGERTIP, 0.0));
    rows.push(of("thermode, thenar", &ObserverParams::THERMODE_THENAR, 0.0));
    rows
}

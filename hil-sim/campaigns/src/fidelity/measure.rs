//! The figure of a run that is compared with a bound.

use serde::Serialize;
use thermal_device::StateName;
use thermal_sim::metrics::skin_errors;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

/// The kind of figure that is compared with a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Largest skin error from a time after each landing on.
    MaxAfter {
        /// Time after landing, s.
        from_s: f64,
        /// Bound, mK.
        bound_mk: f64,
    },
    /// Time after landing or appearance from which the skin error stays below a limit.
    Settles {
        /// Limit of the error, mK.
        below_mk: f64,
        /// Bound, s, if there is one.
        bound_s: Option<f64>,
    },
    /// Percentage of the contact time in which the device reports that it limits the set-point.
    Limited,
}

/// A figure compared with its bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JudgedFigure {
    /// Name of the figure.
    pub figure: &'static str,
    /// Its value; `None` if it is undefined for the run.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// Bound, if there is one: an upper bound, for `limited` a lower bound.
    pub bound: Option<f64>,
    /// Whether it is within the bound.
    pub within: Option<bool>,
}

impl Measure {
    /// For a finger that lands and stays: 20 mK from 50 ms on.
    pub const LANDING: Self = Self::MaxAfter { from_s: 0.05, bound_mk: 20.0 };
    /// For a finger that lifts, or whose force changes: 50 mK from 100 ms on.
    pub const CHANGING: Self = Self::MaxAfter { from_s: 0.1, bound_mk: 50.0 };

    /// Computes the figure of a run.
    pub fn evaluate(&self, scene: &Scene, outcome: &Outcome) -> JudgedFigure {
        let errors = skin_errors(scene, outcome);
        match *self {
            Self::MaxAfter { from_s, bound_mk } => {
                judged("max", max_after(errors, from_s), "mK", Some(bound_mk))
            }
            Self::Settles { below_mk, bound_s } => {
                judged("settles", settled(errors, below_mk), "s", bound_s)
            }
            Self::Limited => {
                let value = limited(outcome);
                JudgedFigure {
                    figure: "limited",
                    value,
                    unit: "%",
                    bound: Some(100.0),
                    within: value.map(|percent| percent >= 100.0),
                }
            }
        }
    }
}

fn judged(
    figure: &'static str,
    value: Option<f64>,
    unit: &'static str,
    bound: Option<f64>,
) -> JudgedFigure {
    JudgedFigure {
        figure,
        value,
        unit,
        bound,
        within: bound.zip(value).map(|(bound, value)| value <= bound),
    }
}

/// Largest magnitude, mK, from a time after landing on; `errors` has times after landing, s, and errors, K.
fn max_after(errors: impl Iterator<Item = (f64, f64)>, from_s: f64) -> Option<f64> {
    // Tolerance of half a row for rounding of the times.
    let late = errors.filter(|(since_s, _)| *since_s > from_s - 0.5e-3);
    late.map(|(_, error_k)| error_k.abs() * 1e3).reduce(f64::max)
}

/// The first time after which no error reaches the limit; `None` if the last one does.
fn settled(errors: impl Iterator<Item = (f64, f64)>, below_mk: f64) -> Option<f64> {
    let mut settled_s = None;
    for (since_s, error_k) in errors {
        if error_k.abs() * 1e3 >= below_mk {
            settled_s = None;
        } else if settled_s.is_none() {
            settled_s = Some(since_s);
        }
    }
    settled_s
}

/// Percentage of the rows in contact in which the device reports `limited`.
fn limited(outcome: &Outcome) -> Option<f64> {
    let (mut contact, mut limited) = (0u32, 0u32);
    for device in outcome.trace.rows().iter().filter_map(|row| row.device.as_ref()) {
        if device.state == StateName::Contact {
            contact += 1;
            limited += u32::from(device.limited);
        }
    }
    (contact > 0).then(|| 100.0 * f64::from(limited) / f64::from(contact))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An error of 0.3 K that decays with a time constant of 0.2 s and alternates in sign.
    fn decay() -> impl Iterator<Item = (f64, f64)> {
        (0..2000).map(|ms| {
            let t_s = f64::from(ms) * 1e-3;
            let sign = if ms % 2 == 0 { 1.0 } else { -1.0 };
            (t_s, sign * 0.3 * (-t_s / 0.2).exp())
        })
    }

    #[test]
    fn the_first_error_of_an_exponential_is_the_largest() {
        let max_mk = max_after(decay(), 0.05).expect("rows");
        assert!((max_mk - 300.0 * (-0.25f64).exp()).abs() < 1e-9, "{max_mk}");
        assert_eq!(max_after(decay(), 5.0), None);
    }

    /// 0.2 ln(300 / 50) = 0.35835 s: the row at 0.359 s is the first within.
    #[test]
    fn an_exponential_settles_at_the_calculated_time() {
        assert_eq!(settled(decay(), 50.0), Some(0.359));
        assert_eq!(settled(decay(), 1e-3), None);
        assert_eq!(settled(decay(), 301.0), Some(0.0));
    }

    #[test]
    fn an_error_that_returns_has_not_settled() {
        let errors = [(0.0, 0.2), (0.001, 0.01), (0.002, 0.06), (0.003, -0.01)];
        assert_eq!(settled(errors.into_iter(), 50.0), Some(0.003));
    }
}

//! Errors of the kernels, and the arguments from which on they fail.
use contact_model::fixed_point::Ticks;
use model_bench::inputs::Input;
use model_bench::kernels::Call;
use serde::Serialize;

use super::precise::{Twofold, erfcx_of_root, exact_product};

/// 2^32: errors are in units of the fixed-point result.
const UNITS: f64 = 4_294_967_296.0;
/// The temperature step at which errors are given in mK.
pub const STEP_K: f64 = 60.0;
/// A relative error above this counts as a failure.
const BREAK: f64 = 0.01;
/// Range of `z` that is searched for failures: the inputs' domain, extended downwards.
const Z: std::ops::Range<f64> = 1e-4..256.0;
/// Steps of `z` per octave.
const STEPS: f64 = 256.0;

/// Errors of one kernel over the inputs for which it gives a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// Largest absolute error, in 2^-32.
    pub worst_units: f64,
    /// Mean absolute error, in 2^-32.
    pub mean_units: f64,
    /// Largest absolute error times [`STEP_K`], mK.
    pub worst_mk: f64,
    /// Smallest z from which the result is NaN, infinite or off by more than 1 %.
    pub breaks_at_z: Option<f64>,
}

/// Inputs with their exact results.
pub struct Truth {
    cases: Vec<(Input, Twofold)>,
}

fn exact(input: &Input) -> Twofold {
    erfcx_of_root(exact_product(f64::from(input.elapsed.get()), input.double))
}

impl Truth {
    /// The inputs with the numbers 0 to `count` - 1.
    pub fn new(count: u32) -> Self {
        let inputs = (0..count).filter_map(Input::nth);
        Self { cases: inputs.map(|input| (input, exact(&input))).collect() }
    }

    /// The inputs.
    pub fn inputs(&self) -> Vec<Input> {
        self.cases.iter().map(|(input, _)| *input).collect()
    }

    /// Errors of a kernel.
    pub fn judge(&self, call: Call) -> Accuracy {
        let errors: Vec<f64> = self
            .cases
            .iter()
            .map(|(input, truth)| error(call, input, *truth).abs() * UNITS)
            .filter(|error| error.is_finite())
            .collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        Accuracy {
            worst_units: worst,
            mean_units: errors.iter().sum::<f64>() / errors.len().max(1) as f64,
            worst_mk: worst / UNITS * STEP_K * 1e3,
            breaks_at_z: breaks_at(call),
        }
    }
}

/// Error of a result; NaN or infinite if the result is.
fn error(call: Call, input: &Input, truth: Twofold) -> f64 {
    (call.on(input).to_f64() - truth.high) - truth.low
}

/// Whether the kernel fails at `z`.
fn broken(call: Call, z: f64) -> bool {
    Input::new(Ticks::ONE, z * z).is_some_and(|input| {
        let truth = exact(&input);
        let error = error(call, &input, truth).abs();
        error.is_nan() || error > BREAK * truth.high
    })
}

/// Smallest argument of a failure, to 1e-6 relative.
fn breaks_at(call: Call) -> Option<f64> {
    let steps = ((Z.end / Z.start).log2() * STEPS) as u32;
    let z = |step: u32| Z.start * (f64::from(step) / STEPS).exp2();
    let first = (0..=steps).find(|step| broken(call, z(*step)))?;
    let (mut good, mut bad) = (z(first.saturating_sub(1)), z(first));
    while bad - good > 1e-6 * bad {
        let middle = 0.5 * (good + bad);
        if broken(call, middle) {
            bad = middle;
        } else {
            good = middle;
        }
    }
    Some(bad)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 50-digit values of the model's test data.
    #[test]
    fn the_exact_kernel_agrees_with_golden_values() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../model/tests/data/erfcx.csv");
        let mut reader = csv::Reader::from_path(path).unwrap();
        let mut checked = 0;
        for record in reader.records() {
            let record = record.unwrap();
            let z: f64 = record[0].parse().unwrap();
            let truth: f64 = record[3].parse().unwrap();
            if (1e-6..1e6).contains(&z) {
                let found = erfcx_of_root(exact_product(z, z)).high;
                assert!(
                    (found - truth).abs() <= 2.0 * f64::EPSILON * truth,
                    "{z}: {found} for {truth}"
                );
                checked += 1;
            }
        }
        assert!(checked > 50, "{checked}");
    }
}

//! The components in which fingers differ from the mean finger.

use contact_model::finger::MEAN;
use nalgebra::{DMatrix, DVector, Dyn, SVD};

use crate::fit::logarithmic;

/// Number of components.
const COMPONENTS: usize = 2;
/// Weights of the mean finger that differ: those of its relaxations, without the integrator, and the direct term.
const WEIGHTS: usize = 9;
/// Laplace variables, 1/s, at which impedances are compared: those of times from 1.4 ms to 20 s.
const SAMPLES: usize = 120;
const S_MIN_1_S: f64 = 0.05;
const S_MAX_1_S: f64 = 700.0;
/// Weight of the relative weights in their fit, beside errors of the impedance: keeps neighbouring weights alike, so that all
/// of them stay positive for every finger.
const RIDGE: f64 = 0.1;

/// The two largest components of the relative differences of fingers from the mean finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Components {
    /// Relative deviations of the mean finger's weights per unit of each component: of its relaxations from the slowest to the
    /// fastest, without the integrator, then of the direct term.
    pub weights: [[f64; WEIGHTS]; COMPONENTS],
    /// Mean of each component over the fingers, whose standard deviation is 1.
    pub means: [f64; COMPONENTS],
    /// Rms relative error of the fingers' impedances with none, one and both of the components.
    pub errors: [f64; COMPONENTS + 1],
    /// Least weight of any finger, over the mean finger's.
    pub least_weight: f64,
}

/// The components of fingers, given by their surface impedances, m² K/W, at a real Laplace variable, 1/s.
///
/// # Panics
/// There are fewer than two fingers, or all are alike.
pub fn components(fingers: &[impl Fn(f64) -> f64]) -> Components {
    let mean = &MEAN.impedance;
    let samples: Vec<_> = logarithmic(S_MIN_1_S, S_MAX_1_S, SAMPLES).collect();
    let deviations = DMatrix::from_fn(SAMPLES, fingers.len(), |sample, finger| {
        let s_1_s = samples[sample];
        fingers[finger](s_1_s) / mean.at(s_1_s) - 1.0
    });
    let shares = DMatrix::from_fn(SAMPLES, WEIGHTS, |sample, weight| {
        let s_1_s = samples[sample];
        let with_rate = mean.relaxations.iter().filter(|one| one.rate_1_s > 0.0);
        let term = with_rate
            .map(|one| one.gain_m2k_j / (s_1_s + one.rate_1_s))
            .nth(weight)
            .unwrap_or(mean.direct_m2k_w);
        term / mean.at(s_1_s)
    });
    let normal = shares.tr_mul(&shares) + DMatrix::identity(WEIGHTS, WEIGHTS) * RIDGE * RIDGE;
    let inverse = normal.try_inverse().expect("positive by the ridge");

    let decomposition: SVD<f64, Dyn, Dyn> = deviations.clone().svd_unordered(true, true);
    let [left, right] = [decomposition.u, decomposition.v_t].map(|one| one.expect("computed"));
    let mut largest: Vec<_> = (0..decomposition.singular_values.len()).collect();
    largest.sort_by(|&a, &b| {
        decomposition.singular_values[b].total_cmp(&decomposition.singular_values[a])
    });
    let count = fingers.len() as f64;
    let mut rest = deviations;
    let rms = |of: &DMatrix<f64>| (of.norm_squared() / of.len() as f64).sqrt();
    let mut result = Components {
        weights: [[0.0; WEIGHTS]; COMPONENTS],
        means: [0.0; COMPONENTS],
        errors: [rms(&rest); COMPONENTS + 1],
        least_weight: 0.0,
    };
    let mut weights = DMatrix::from_element(WEIGHTS, fingers.len(), 1.0);
    for (component, &chosen) in largest.iter().take(COMPONENTS).enumerate() {
        let scores = right.row(chosen) * decomposition.singular_values[chosen];
        let mean_score = scores.mean();
        let deviation = (scores.norm_squared() / count - mean_score * mean_score).sqrt();
        // A higher value of a component is a finger that its surface moves less after some seconds.
        let curve: DVector<f64> = left.column(chosen) * deviation;
        let sign = -curve.sum().signum();
        let fitted = &inverse * shares.tr_mul(&(curve * sign));
        let scores = scores * (sign / deviation);
        result.means[component] = scores.mean();
        rest -= &shares * &fitted * &scores;
        weights += &fitted * &scores;
        result.errors[component + 1] = rms(&rest);
        result.weights[component].copy_from_slice(fitted.as_slice());
    }
    result.least_weight = weights.min();
    result
}

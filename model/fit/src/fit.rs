//! Fit of relaxations to an exact surface impedance.

use contact_model::impedance::{Impedance, Relaxation};
use contact_model::slab::RATE_MAX_1_S;
use nalgebra::{DMatrix, DVector};

use crate::nonnegative;

/// Slowest rate, 1/s; an integrator stands for slower ones.
const RATE_MIN_1_S: f64 = 2e-4;
/// Number of rates offered to the fit, evenly spaced in the logarithm.
const RATES: usize = 150;
/// Number of Laplace variables at which the impedance is compared, evenly spaced in the logarithm from [`S_MIN_1_S`] to
/// [`S_MAX_1_S`].
const SAMPLES: usize = 200;
const S_MIN_1_S: f64 = 0.01;
const S_MAX_1_S: f64 = 600.0;
/// Neighbouring relaxations whose rates differ by less than this factor are merged.
const MERGED_FACTOR: f64 = 1.25;
/// A relaxation is left out if its weighted part of the impedance is below this at every sample.
const NEGLIGIBLE: f64 = 1e-7;

/// Relaxations of a body, fitted to its impedance.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Direct term, m² K/W.
    pub direct_m2k_w: f64,
    /// Relaxations, the slowest first.
    pub relaxations: Vec<Relaxation>,
    /// Largest weighted error of the impedance over the samples.
    pub weighted_error: f64,
}

impl Fit {
    /// The fitted impedance.
    pub fn impedance(&self) -> Impedance<'_> {
        Impedance { direct_m2k_w: self.direct_m2k_w, relaxations: &self.relaxations }
    }
}

/// `count` values, evenly spaced in the logarithm.
pub fn logarithmic(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| from * (to / from).powf(i as f64 / (count - 1) as f64))
}

/// Samples of an impedance: Laplace variable, impedance, and weight of the error.
struct Samples(Vec<(f64, f64, f64)>);

impl Samples {
    /// Weighted values of `term` at the samples: one column of the least-squares problem.
    fn column(&self, term: impl Fn(f64) -> f64) -> Vec<f64> {
        self.0.iter().map(|(s, _, weight)| weight * term(*s)).collect()
    }

    /// Least-squares fit of relaxations of these rates, without those that are negligible.
    fn fit(&self, rates: impl Iterator<Item = f64>) -> Fit {
        let rates: Vec<f64> = rates.collect();
        let mut columns = vec![self.column(|_| 1.0)];
        columns.extend(rates.iter().map(|rate| self.column(|s| 1.0 / (s + rate))));
        let norms: Vec<f64> = (columns.iter())
            .map(|column| column.iter().map(|x| x * x).sum::<f64>().sqrt())
            .collect();
        let a = DMatrix::from_fn(self.0.len(), columns.len(), |row, column| {
            columns[column][row] / norms[column]
        });
        let b = DVector::from_iterator(self.0.len(), self.0.iter().map(|(_, z, w)| z * w));
        let x = nonnegative::solve(&a, &b);
        // The first column is that of the direct term.
        let terms = x.iter().zip(&columns).zip(&norms).skip(1);
        let relaxations = (rates.iter().zip(terms))
            .filter_map(|(&rate_1_s, ((scaled_gain, column), norm))| {
                let gain_m2k_j = scaled_gain / norm;
                let largest = column.iter().fold(0.0f64, |largest, x| largest.max(*x));
                (gain_m2k_j * largest > NEGLIGIBLE).then_some(Relaxation { rate_1_s, gain_m2k_j })
            })
            .collect();
        Fit { direct_m2k_w: x[0] / norms[0], relaxations, weighted_error: (&a * &x - &b).amax() }
    }
}

/// Merges relaxations `i` and `i + 1` into one with the sum of their gains and, at the slowest sample, the same impedance. An
/// integrator stays one if the merged rate is below [`RATE_MIN_1_S`].
fn merge(relaxations: &mut Vec<Relaxation>, i: usize) {
    let (a, b) = (relaxations[i], relaxations.remove(i + 1));
    let gain = a.gain_m2k_j + b.gain_m2k_j;
    let part = |one: Relaxation| one.gain_m2k_j / (one.rate_1_s + S_MIN_1_S);
    let rate = gain / (part(a) + part(b)) - S_MIN_1_S;
    relaxations[i] = Relaxation {
        rate_1_s: if a.rate_1_s == 0.0 && rate < RATE_MIN_1_S { 0.0 } else { rate },
        gain_m2k_j: gain,
    };
}

/// Fits at most `count_max` relaxations to the impedance `exact(s)`, m² K/W, at real `s` in 1/s, by least squares of the
/// error of the impedance times `weight(s, exact(s))`.
pub fn fit(exact: impl Fn(f64) -> f64, weight: impl Fn(f64, f64) -> f64, count_max: usize) -> Fit {
    let samples = Samples(
        logarithmic(S_MIN_1_S, S_MAX_1_S, SAMPLES)
            .map(|s| {
                let z = exact(s);
                (s, z, weight(s, z))
            })
            .collect(),
    );
    let offered = core::iter::once(0.0).chain(logarithmic(RATE_MIN_1_S, RATE_MAX_1_S, RATES));
    let mut relaxations = samples.fit(offered).relaxations;
    let mut i = 0;
    while i + 1 < relaxations.len() {
        let (a, b) = (relaxations[i].rate_1_s, relaxations[i + 1].rate_1_s);
        if a > 0.0 && b < MERGED_FACTOR * a {
            merge(&mut relaxations, i);
        } else {
            i += 1;
        }
    }
    let solve =
        |relaxations: &[Relaxation]| samples.fit(relaxations.iter().map(|one| one.rate_1_s));
    let mut best = solve(&relaxations);
    while best.relaxations.len() > count_max {
        let merged = (0..best.relaxations.len() - 1).map(|i| {
            let mut fewer = best.relaxations.clone();
            merge(&mut fewer, i);
            solve(&fewer)
        });
        let Some(least) = merged.min_by(|a, b| a.weighted_error.total_cmp(&b.weighted_error))
        else {
            break;
        };
        best = least;
    }
    best
}

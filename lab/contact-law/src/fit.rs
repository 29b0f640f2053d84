//! Non-linear least squares of contact law and tissue.

use contact_model::contact_law::ContactLaw;
use contact_model::finger::COMPONENT_MEANS;
use contact_model::material::{SKIN, Surface};
use contact_model::pressure::pressure_pa;
use contact_model::reference::conductance_at_hardness;
use nalgebra::{SMatrix, SVector};

use crate::ramps::{FORCES_N, RAMPS, ramp_at};
use crate::recording::{Recording, RecordingError};
use crate::thermal_signals::{EQUATION_S, Equation, PROPERTIES, equations};

/// Unknowns: the logarithm of the spots' conductance at [`MIDDLE_N`], the exponent, the gap's conductance over
/// [`GAP_UNIT_W_M2K`], and the properties of the finger.
const UNKNOWNS: usize = 3 + PROPERTIES;
const LOG_SPOT_CONDUCTANCE: usize = 0;
const EXPONENT: usize = 1;
const GAP: usize = 2;

/// Force in the middle of the ramps, N.
const MIDDLE_N: f64 = 0.447;
/// Unit of the gap's conductance, W/(m² K), so that all unknowns are near 1.
const GAP_UNIT_W_M2K: f64 = 100.0;
/// Prior of the finger's properties: mean and standard deviation of the two components, of the air's flux, and of the skin, K.
const PRIOR: [(f64, f64); PROPERTIES] =
    [(COMPONENT_MEANS[0], 1.0), (COMPONENT_MEANS[1], 1.0), (0.0, 0.48), (0.0, 0.05)];
/// Prior of the exponent: that of Eq. 6-8, and the spread of other correlations for spots in contact, 0.85 to 1. It matters where
/// there is a gap, which looks much like a smaller exponent.
const EXPONENT_PRIOR: (f64, f64) = (0.95, 0.05);
/// Time after landing from which on samples count, s.
const FROM_S: f64 = 0.1;
/// Error of the model: its standard deviation just after landing, K; the time in which that doubles, s, because deep tissue and
/// blood are modelled worse than the epidermis; and the time over which its values are correlated, s.
const MODEL_ERROR_K: f64 = 0.02;
const MODEL_ERROR_DOUBLED_S: f64 = 5.0;
const MODEL_ERROR_CORRELATION_S: f64 = 0.5;
/// Least reduction of the weighted sum of squares for which the gap is kept.
const GAP_CHI2_REDUCTION_MIN: f64 = 9.0;
/// Largest number of iterations, and the relative fall of the sum of squares at which they end.
const ITERATIONS_MAX: usize = 100;
const CONVERGED: f64 = 1e-10;

type Unknowns = SVector<f64, UNKNOWNS>;

/// Limits of an interval of 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}

/// A fitted contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The law.
    pub law: ContactLaw,
    /// Contact resistance of skin and display at each of [`FORCES_N`], m² K/W.
    pub resistances_m2k_w: [f64; FORCES_N.len()],
    /// Their intervals.
    pub resistance_intervals_m2k_w: [Interval; FORCES_N.len()],
    /// Interval of the exponent.
    pub exponent_interval: Interval,
    /// Interval of the gap's conductance, W/(m² K); zero if there is none.
    pub gap_interval_w_m2k: Interval,
    /// Weighted sum of squares without a gap less that with one. The gap is kept if this is more than 9.
    pub chi2_reduction_by_gap: f64,
    /// RMS of the residuals, K.
    pub residual_k: f64,
}

/// The problem: equations with the ramps that they belong to.
struct Problem {
    equations: Vec<(Equation, usize, f64)>,
}

/// A solution, and the sum of squares there.
#[derive(Clone, Copy, Debug)]
struct Solution {
    unknowns: Unknowns,
    squares: f64,
}

/// `ln(P / P_middle)`: natural logarithm of the pressure under a force over that under [`MIDDLE_N`].
fn log_pressure(force_n: f64) -> f64 {
    (pressure_pa(force_n) / pressure_pa(MIDDLE_N)).ln()
}

fn conductance_w_m2k(unknowns: &Unknowns, log_pressure: f64) -> (f64, f64) {
    let spots = (unknowns[LOG_SPOT_CONDUCTANCE] + unknowns[EXPONENT] * log_pressure).exp();
    (spots, GAP_UNIT_W_M2K * unknowns[GAP])
}

fn resistance_m2k_w(unknowns: &Unknowns, force_n: f64) -> f64 {
    let (spots, gap) = conductance_w_m2k(unknowns, log_pressure(force_n));
    1.0 / (spots + gap)
}

impl Problem {
    fn new(recording: &Recording) -> Self {
        let counted = equations(recording).into_iter().filter_map(|equation| {
            let ramp = ramp_at(equation.since_s)?;
            (equation.since_s >= FROM_S)
                .then(|| (equation, ramp, log_pressure(equation.log_force.exp())))
        });
        Self { equations: counted.collect() }
    }

    /// Normal equations of the next step, and the sum of squares, in which each ramp counts `times` times.
    fn normal(
        &self,
        unknowns: &Unknowns,
        times: &[f64; RAMPS],
    ) -> (SMatrix<f64, UNKNOWNS, UNKNOWNS>, Unknowns, f64) {
        let mut matrix = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
        let (mut gradient, mut squares) = (Unknowns::zeros(), 0.0);
        for (equation, ramp, log_pressure) in &self.equations {
            let (spots, gap) = conductance_w_m2k(unknowns, *log_pressure);
            let resistance = 1.0 / (spots + gap);
            let per_spots = resistance * resistance * equation.flux_w_m2;
            let mut slopes = Unknowns::zeros();
            slopes[LOG_SPOT_CONDUCTANCE] = per_spots * spots;
            slopes[EXPONENT] = per_spots * spots * log_pressure;
            slopes[GAP] = per_spots * GAP_UNIT_W_M2K;
            let mut left = equation.difference_k - resistance * equation.flux_w_m2;
            for (of, slope) in equation.per_property.iter().enumerate() {
                slopes[3 + of] = *slope;
                left += slope * unknowns[3 + of];
            }
            let model_k = MODEL_ERROR_K * (1.0 + equation.since_s / MODEL_ERROR_DOUBLED_S);
            let weight =
                times[*ramp] * EQUATION_S / MODEL_ERROR_CORRELATION_S / (model_k * model_k);
            squares += weight * left * left;
            matrix.syger(weight, &slopes, &slopes, 1.0);
            gradient.axpy(weight * left, &slopes, 1.0);
        }
        for (of, (mean, deviation)) in PRIOR.iter().enumerate() {
            let left = (unknowns[3 + of] - mean) / deviation;
            squares += left * left;
            matrix[(3 + of, 3 + of)] += 1.0 / (deviation * deviation);
            gradient[3 + of] += left / deviation;
        }
        let (mean, deviation) = EXPONENT_PRIOR;
        let left = (unknowns[EXPONENT] - mean) / deviation;
        squares += left * left;
        matrix[(EXPONENT, EXPONENT)] += 1.0 / (deviation * deviation);
        gradient[EXPONENT] += left / deviation;
        (matrix, gradient, squares)
    }

    /// The unknowns of the least sum of squares, by Gauss's and Newton's method with the damping of Levenberg and Marquardt.
    fn solve(&self, start: &Unknowns, times: &[f64; RAMPS], has_gap: bool) -> Solution {
        let mut unknowns = *start;
        let (mut matrix, mut gradient, mut squares) = self.normal(&unknowns, times);
        let mut damping = 1e-3;
        for _ in 0..ITERATIONS_MAX {
            let mut damped = matrix;
            damped.fill_upper_triangle_with_lower_triangle();
            for of in 0..UNKNOWNS {
                damped[(of, of)] *= 1.0 + damping;
            }
            let mut right = gradient;
            // A gap that is zero and would become negative stays.
            if !has_gap || (unknowns[GAP] <= 0.0 && gradient[GAP] > 0.0) {
                damped.row_mut(GAP).fill(0.0);
                damped.column_mut(GAP).fill(0.0);
                damped[(GAP, GAP)] = 1.0;
                right[GAP] = 0.0;
            }
            let Some(step) = damped.cholesky().map(|factor| factor.solve(&right)) else {
                break;
            };
            let mut next = unknowns - step;
            next[EXPONENT] =
                next[EXPONENT].clamp(*ContactLaw::EXPONENTS.start(), *ContactLaw::EXPONENTS.end());
            next[GAP] = next[GAP].max(0.0);
            let normal = self.normal(&next, times);
            if normal.2 < squares {
                let fall = squares - normal.2;
                (matrix, gradient, squares) = normal;
                unknowns = next;
                damping *= 0.1;
                if fall < CONVERGED * squares {
                    break;
                }
            } else if damping < 1e9 {
                damping *= 10.0;
            } else {
                break;
            }
        }
        Solution { unknowns, squares }
    }

    fn residual_k(&self, unknowns: &Unknowns) -> f64 {
        let left = self.equations.iter().map(|(equation, _, log_pressure)| {
            let (spots, gap) = conductance_w_m2k(unknowns, *log_pressure);
            let own = equation.per_property.iter().zip(unknowns.iter().skip(3));
            let own: f64 = own.map(|(slope, unknown)| slope * unknown).sum();
            equation.difference_k + own - equation.flux_w_m2 / (spots + gap)
        });
        (left.map(|left| left * left).sum::<f64>() / self.equations.len() as f64).sqrt()
    }
}

/// The resamples of four ramps out of four: how often each has each ramp, and its probability.
fn resamples() -> impl Iterator<Item = ([f64; RAMPS], f64)> {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    (0..(RAMPS + 1).pow(RAMPS as u32)).filter_map(move |code| {
        let times: [usize; RAMPS] =
            std::array::from_fn(|ramp| code / (RAMPS + 1).pow(ramp as u32) % (RAMPS + 1));
        (times.iter().sum::<usize>() == RAMPS).then(|| {
            let ways = factorial(RAMPS) / times.iter().map(|n| factorial(*n)).product::<f64>();
            (times.map(|n| n as f64), ways / (RAMPS as f64).powi(RAMPS as i32))
        })
    })
}

/// The interval around a fitted value, from its values in resamples and their probabilities.
fn interval(fitted: f64, values: impl Iterator<Item = (f64, f64)> + Clone) -> Interval {
    /// Two-sided 95 % of Student's t with three degrees of freedom, times `sqrt(4/3)`, by which resamples of four values
    /// underestimate the deviation.
    const HALF_WIDTH_PER_DEVIATION: f64 = 3.182 * 1.1547;
    let mean: f64 = values.clone().map(|(value, weight)| weight * value).sum();
    let variance: f64 = values.map(|(value, weight)| weight * (value - mean).powi(2)).sum();
    let half = HALF_WIDTH_PER_DEVIATION * variance.sqrt();
    Interval { low: fitted - half, high: fitted + half }
}

/// Mean conductance of the thesis's skin on a surface, W/(m² K).
fn at_hardness_w_m2k(display: &Surface) -> f64 {
    conductance_at_hardness::<f64>(&SKIN.surface, display)
}

/// Fits contact law and tissue of one finger to a recording.
///
/// # Errors
/// The recording does not pass its [check](Recording::check).
pub fn fit(recording: &Recording) -> Result<Fit, RecordingError> {
    recording.check()?;
    let problem = Problem::new(recording);
    let at_hardness_w_m2k = at_hardness_w_m2k(&recording.display);
    let nominal = ContactLaw::NOMINAL;
    let middle = nominal.conductance_w_m2k(at_hardness_w_m2k, pressure_pa(MIDDLE_N));
    let mut start = Unknowns::zeros();
    (start[LOG_SPOT_CONDUCTANCE], start[EXPONENT]) = (middle.ln(), nominal.exponent);
    for (of, (mean, _)) in PRIOR.iter().enumerate() {
        start[3 + of] = *mean;
    }
    let once = [1.0; RAMPS];
    let without = problem.solve(&start, &once, false);
    let with = problem.solve(&without.unknowns, &once, true);
    let chi2_reduction_by_gap = without.squares - with.squares;
    let has_gap = chi2_reduction_by_gap > GAP_CHI2_REDUCTION_MIN;
    let best = if has_gap { with } else { without }.unknowns;

    let again: Vec<(Unknowns, f64)> = resamples()
        .map(|(times, weight)| (problem.solve(&best, &times, has_gap).unknowns, weight))
        .collect();
    let of = |value: &dyn Fn(&Unknowns) -> f64| {
        let values: Vec<_> =
            again.iter().map(|(unknowns, weight)| (value(unknowns), *weight)).collect();
        interval(value(&best), values.into_iter())
    };
    let ends = |force_n: f64| {
        let logarithm = of(&|unknowns| resistance_m2k_w(unknowns, force_n).ln());
        Interval { low: logarithm.low.exp(), high: logarithm.high.exp() }
    };
    let exponent = best[EXPONENT];
    // The microhardness at which the spots have their conductance at the middle force.
    let relative = (best[LOG_SPOT_CONDUCTANCE].exp() / at_hardness_w_m2k).powf(1.0 / exponent);
    let gap_interval = of(&|unknowns| GAP_UNIT_W_M2K * unknowns[GAP]);
    Ok(Fit {
        law: ContactLaw {
            exponent,
            hardness_pa: pressure_pa(MIDDLE_N) / relative,
            gap_w_m2k: GAP_UNIT_W_M2K * best[GAP],
        },
        resistances_m2k_w: FORCES_N.map(|force_n| resistance_m2k_w(&best, force_n)),
        resistance_intervals_m2k_w: FORCES_N.map(ends),
        exponent_interval: of(&|unknowns| unknowns[EXPONENT]),
        gap_interval_w_m2k: Interval { low: gap_interval.low.max(0.0), ..gap_interval },
        chi2_reduction_by_gap,
        residual_k: problem.residual_k(&best),
    })
}

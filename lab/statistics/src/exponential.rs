//! Exponential course of a temperature.

use crate::error::{at_least, checked};
use crate::sample::{check_equal_lengths, check_rows, mean_of, sum_of_squares, varies};
use crate::search::golden_section;
use crate::{Result, StatisticsError};

/// `T = c + a exp(-t / tau)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialFit {
    /// `c`: value after a long time, in the data's unit.
    pub offset: f64,
    /// `a`: value at `t = 0` less the offset.
    pub amplitude: f64,
    /// `tau`, in the unit of `t`.
    pub time_constant: f64,
    /// Part of the sum of squares that the fit explains, 1 for an exact fit.
    pub r_squared: f64,
}

/// Least-squares fit of an exponential by variable projection (Golub and Pereyra, 1973): for each `tau` the best `c` and `a`
/// follow from a linear regression, and `ln tau` is searched, first on a grid and then by golden section. Time constants are
/// searched from a fifth of the mean interval of the times to 20 times their span. Relative error of `tau` below 1e-6 where
/// the data contain at least a time constant.
///
/// # Errors
/// Fewer than four points, `t` and `y` of different length, a number that is not finite, a negative `t`, a constant `y` or `t`,
/// or no best time constant within the range, as for a straight line.
pub fn fit_exponential(t: &[f64], y: &[f64]) -> Result<ExponentialFit> {
    /// Factor between time constants of the grid.
    const FACTOR: f64 = 1.1;
    check_equal_lengths("variable", &[t, y])?;
    check_rows("variable", &[t, y])?;
    at_least("points", t.len(), 4)?;
    let first = t.iter().copied().fold(f64::MAX, f64::min);
    let last = t.iter().copied().fold(f64::MIN, f64::max);
    checked("earliest time", first, "0 or more", |t| t >= 0.0)?;
    let total = sum_of_squares(y);
    if last <= first || !varies(total, y.iter().copied()) {
        return Err(StatisticsError::NoVariation { what: "the time or the fitted quantity" });
    }
    let line = |ln_tau: f64| Line::fit(t, y, first, ln_tau.exp());
    let low = (0.2 * (last - first) / (t.len() - 1) as f64).ln();
    let high = (20.0 * (last - first)).ln();
    let steps = ((high - low) / FACTOR.ln()).ceil();
    let grid = |i: f64| low + (high - low) * i / steps;
    let mut best = (0.0, f64::INFINITY);
    for i in 0..=steps as u32 {
        let i = f64::from(i);
        let residual = line(grid(i)).residual;
        if residual < best.1 {
            best = (i, residual);
        }
    }
    let undetermined = StatisticsError::NotDetermined { what: "the time constant" };
    if best.0 == 0.0 || best.0 == steps {
        return Err(undetermined);
    }
    let residual = |ln_tau| line(ln_tau).residual;
    let ln_tau = golden_section(residual, grid(best.0 - 1.0), grid(best.0 + 1.0));
    let line = line(ln_tau);
    let time_constant = ln_tau.exp();
    let amplitude = line.amplitude * (first / time_constant).exp();
    if !amplitude.is_finite() {
        return Err(undetermined);
    }
    Ok(ExponentialFit {
        offset: line.offset,
        amplitude,
        time_constant,
        r_squared: 1.0 - line.residual / total,
    })
}

/// Best offset, and amplitude at the first time, for a time constant.
struct Line {
    offset: f64,
    amplitude: f64,
    residual: f64,
}

impl Line {
    fn fit(t: &[f64], y: &[f64], first: f64, tau: f64) -> Self {
        // exp - 1 keeps the digits of a course much shorter than tau.
        let decay: Vec<f64> = t.iter().map(|t| (-(t - first) / tau).exp_m1()).collect();
        let (mean, mean_y) = (mean_of(&decay), mean_of(y));
        let pairs = || decay.iter().zip(y).map(|(x, y)| (x - mean, y - mean_y));
        let squares: f64 = pairs().map(|(x, _)| x * x).sum();
        let amplitude = pairs().map(|(x, y)| x * y).sum::<f64>() / squares;
        Self {
            offset: mean_y - amplitude * (1.0 + mean),
            amplitude,
            residual: pairs().map(|(x, y)| (y - amplitude * x).powi(2)).sum(),
        }
    }
}

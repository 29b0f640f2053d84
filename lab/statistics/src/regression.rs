//! Linear regression through the origin.

use crate::error::at_least;
use crate::sample::{check_equal_lengths, check_rows};
use crate::{Result, StatisticsError};

/// A line through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThroughOrigin {
    /// Slope `b = sum x y / sum x²`, in the unit of `y` over that of `x`.
    pub slope: f64,
    /// Standard error of the slope, with `n - 1` degrees of freedom.
    pub standard_error: f64,
    /// Standard deviation of the residuals, in the unit of `y`.
    pub residual_sd: f64,
}

/// Fits `y = b x`, such as readings `y` of an instrument without offset to true values `x`; a reading is corrected by division
/// by the slope.
///
/// # Errors
/// Fewer than two pairs, `x` and `y` of different length, a number that is not finite, or an `x` that is zero throughout.
pub fn through_origin(x: &[f64], y: &[f64]) -> Result<ThroughOrigin> {
    check_equal_lengths("variable", &[x, y])?;
    check_rows("variable", &[x, y])?;
    at_least("pairs", x.len(), 2)?;
    let squares: f64 = x.iter().map(|x| x * x).sum();
    if squares == 0.0 {
        return Err(StatisticsError::NotDetermined { what: "the slope" });
    }
    let slope = x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / squares;
    let residuals = x.iter().zip(y).map(|(x, y)| (y - slope * x).powi(2));
    let residual_sd = (residuals.sum::<f64>() / (x.len() - 1) as f64).sqrt();
    Ok(ThroughOrigin { slope, standard_error: residual_sd / squares.sqrt(), residual_sd })
}

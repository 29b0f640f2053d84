//! Pearson's correlation.

use crate::distribution::{correlation_tail, normal_quantile};
use crate::error::{at_least, inner_probability};
use crate::sample::{check_equal_lengths, check_rows, mean_of, sum_of_squares, varies};
use crate::{Interval, Result, StatisticsError};

/// Correlation of pairs of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Product-moment correlation, from -1 to 1.
    pub r: f64,
    /// Number of pairs.
    pub pairs: usize,
    /// Probability of a correlation of this magnitude or more, of either sign, between uncorrelated pairs.
    pub p: f64,
}

/// Pearson's correlation `r = sum (x - m_x)(y - m_y) / sqrt(sum (x - m_x)² sum (y - m_y)²)`.
///
/// # Errors
/// Fewer than three pairs, `x` and `y` of different length, a number that is not finite, or one that does not vary.
pub fn pearson(x: &[f64], y: &[f64]) -> Result<Correlation> {
    check_equal_lengths("variable", &[x, y])?;
    check_rows("variable", &[x, y])?;
    at_least("pairs", x.len(), 3)?;
    let (of_x, of_y) = (sum_of_squares(x), sum_of_squares(y));
    if !varies(of_x, x.iter().copied()) || !varies(of_y, y.iter().copied()) {
        return Err(StatisticsError::NoVariation { what: "one of the two variables" });
    }
    let (mean_x, mean_y) = (mean_of(x), mean_of(y));
    let products = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y));
    // Rounding may exceed 1 in the last bit.
    let r = (products.sum::<f64>() / (of_x.sqrt() * of_y.sqrt())).clamp(-1.0, 1.0);
    Ok(Correlation { r, pairs: x.len(), p: correlation_tail(r, x.len())? })
}

impl Correlation {
    /// Confidence interval, `tanh(artanh r ± z / sqrt(n - 3))` (Fisher), for a confidence such as 0.95.
    ///
    /// # Errors
    /// Fewer than four pairs, or a confidence that is not between 0 and 1.
    pub fn interval(&self, confidence: f64) -> Result<Interval> {
        at_least("pairs", self.pairs, 4)?;
        let confidence = inner_probability("confidence", confidence)?;
        let z = normal_quantile(0.5 + 0.5 * confidence)?;
        let half = z / ((self.pairs - 3) as f64).sqrt();
        let transformed = self.r.atanh();
        Ok(Interval { low: (transformed - half).tanh(), high: (transformed + half).tanh() })
    }
}

//! Means and sums of squares of observations, and the checks that every statistic makes of its data.

use crate::error::{at_least, is_number};
use crate::{Result, StatisticsError};

/// A confidence interval, in the unit of what is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}

/// Part of the sum of squares of the observations below which a sum of squared differences is rounding alone: a relative
/// error of some 3e-14 of the observations, hundred times that of a sum.
const ROUNDING: f64 = 1e-27;

/// Arithmetic mean.
///
/// # Errors
/// No observation, or one that is not finite.
pub fn mean(values: &[f64]) -> Result<f64> {
    check_row("sample", 0, values)?;
    at_least("observations", values.len(), 1)?;
    Ok(mean_of(values))
}

/// Standard deviation of a sample, `sqrt(sum (y - m)² / (n - 1))`.
///
/// # Errors
/// Fewer than two observations, or one that is not finite.
pub fn standard_deviation(values: &[f64]) -> Result<f64> {
    check_row("sample", 0, values)?;
    at_least("observations", values.len(), 2)?;
    Ok((sum_of_squares(values) / (values.len() - 1) as f64).sqrt())
}

/// Standard error of a mean over participants, `sd / sqrt(N)`.
///
/// # Errors
/// Fewer than two observations, or one that is not finite.
pub fn standard_error_of_mean(values: &[f64]) -> Result<f64> {
    Ok(standard_deviation(values)? / (values.len() as f64).sqrt())
}

/// Mean of checked observations.
pub(crate) fn mean_of(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sum of squared differences from the mean, of checked observations.
pub(crate) fn sum_of_squares(values: &[f64]) -> f64 {
    let mean = mean_of(values);
    values.iter().map(|y| (y - mean) * (y - mean)).sum()
}

/// Whether a sum of squared differences of these observations is more than rounding.
pub(crate) fn varies(sum_of_squares: f64, observations: impl Iterator<Item = f64>) -> bool {
    sum_of_squares > ROUNDING * observations.map(|y| y * y).sum::<f64>()
}

pub(crate) fn check_row(what: &'static str, row: usize, values: &[f64]) -> Result<()> {
    match values.iter().position(|&y| !is_number(y)) {
        Some(column) => Err(StatisticsError::NotFinite { what, row, column }),
        None => Ok(()),
    }
}

/// Checks that all observations are numbers.
pub(crate) fn check_rows<R: AsRef<[f64]>>(what: &'static str, rows: &[R]) -> Result<()> {
    let mut numbered = rows.iter().enumerate();
    numbered.try_for_each(|(row, values)| check_row(what, row, values.as_ref()))
}

/// Checks that all rows are as long as the first one.
pub(crate) fn check_equal_lengths<T, R: AsRef<[T]>>(what: &'static str, rows: &[R]) -> Result<()> {
    let expected = rows.first().map_or(0, |row| row.as_ref().len());
    for (row, values) in rows.iter().enumerate() {
        let count = values.as_ref().len();
        if count != expected {
            return Err(StatisticsError::Unbalanced { what, row, count, expected });
        }
    }
    Ok(())
}

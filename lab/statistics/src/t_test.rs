//! Student's t of one sample and of pairs.

use crate::distribution::{t_quantile, t_tail};
use crate::error::{at_least, finite, inner_probability};
use crate::sample::{check_equal_lengths, check_row, check_rows, mean_of, sum_of_squares, varies};
use crate::{Interval, Result, StatisticsError};

/// A t test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TTest {
    /// Mean less the expected one, in the data's unit.
    pub difference: f64,
    /// Standard error of the mean.
    pub standard_error: f64,
    /// Difference over its standard error.
    pub t: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Probability of a `t` of this magnitude or more, of either sign, without a difference.
    pub p: f64,
}

/// Whether the mean of a sample is an expected one; `n - 1` degrees of freedom.
///
/// # Errors
/// Fewer than two observations, one that is not finite, or observations that do not vary.
pub fn one_sample(values: &[f64], expected: f64) -> Result<TTest> {
    check_row("sample", 0, values)?;
    at_least("observations", values.len(), 2)?;
    let expected = finite("expected mean", expected)?;
    let squares = sum_of_squares(values);
    if !varies(squares, values.iter().copied()) {
        return Err(StatisticsError::NoVariation { what: "the sample" });
    }
    let count = values.len() as f64;
    let df = count - 1.0;
    let difference = mean_of(values) - expected;
    let standard_error = (squares / df / count).sqrt();
    let t = difference / standard_error;
    Ok(TTest { difference, standard_error, t, df, p: t_tail(t, df)? })
}

/// Whether two observations of each subject differ, first less second.
///
/// # Errors
/// Fewer than two pairs, samples of different length, an observation that is not finite, or differences that do not vary.
pub fn paired(first: &[f64], second: &[f64]) -> Result<TTest> {
    check_equal_lengths("sample", &[first, second])?;
    check_rows("sample", &[first, second])?;
    at_least("pairs", first.len(), 2)?;
    let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    // Rounding of the differences is that of the observations.
    if !varies(sum_of_squares(&differences), first.iter().chain(second).copied()) {
        return Err(StatisticsError::NoVariation { what: "the difference of the pairs" });
    }
    one_sample(&differences, 0.0)
}

impl TTest {
    /// Confidence interval of the difference, for a confidence such as 0.95.
    ///
    /// # Errors
    /// A confidence that is not between 0 and 1.
    pub fn interval(&self, confidence: f64) -> Result<Interval> {
        let confidence = inner_probability("confidence", confidence)?;
        let half = t_quantile(1.0 - confidence, self.df)? * self.standard_error;
        Ok(Interval { low: self.difference - half, high: self.difference + half })
    }
}

//! Tukey's honestly significant difference: all pairs of means, with one probability of a false alarm for all together.

use crate::anova::one_way;
use crate::distribution::degrees;
use crate::error::{at_least, checked};
use crate::sample::check_row;
use crate::studentized_range::{studentized_range_quantile, studentized_range_tail};
use crate::{Interval, Result};

/// A pair of means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Number of the first mean, from 0.
    pub first: usize,
    /// Number of the second mean, which is larger.
    pub second: usize,
    /// First less second mean, in the data's unit.
    pub difference: f64,
    /// Standard error of a mean of the pair.
    pub standard_error: f64,
    /// Magnitude of the difference over the standard error.
    pub q: f64,
    /// Probability of this `q` or a larger one of any pair, without a difference.
    pub p: f64,
}

/// Comparison of all pairs of means.
#[derive(Clone, Debug, PartialEq)]
pub struct Tukey {
    /// All pairs, by the number of the first and then of the second mean.
    pub pairs: Vec<Pair>,
    means: u32,
    df: f64,
}

/// Compares means of which each is of `n` observations, with the mean square and degrees of freedom of an error term, such as
/// that of [`repeated_measures`](crate::anova::repeated_measures): `q = |m_i - m_j| / sqrt(MS_error / n)`.
///
/// # Errors
/// Fewer than two or more than 50 means, a mean that is not finite, no observations, a mean square that is not positive and
/// finite, or degrees of freedom that are not.
pub fn tukey(means: &[f64], n: usize, mean_square_error: f64, error_df: f64) -> Result<Tukey> {
    tukey_of(means, &vec![n; means.len()], mean_square_error, error_df)
}

/// Compares the means of groups of different subjects against the variation within all groups. Groups of different size have
/// the standard error `sqrt(MS_error / 2 (1 / n_i + 1 / n_j))` (Kramer, 1956).
///
/// # Errors
/// Those of [`one_way`], or more than 50 groups.
pub fn tukey_groups<R: AsRef<[f64]>>(groups: &[R]) -> Result<Tukey> {
    let analysis = one_way(groups)?;
    let sizes: Vec<usize> = groups.iter().map(|group| group.as_ref().len()).collect();
    let error = analysis.effect;
    tukey_of(&analysis.means, &sizes, error.mean_square_error(), error.error_df)
}

fn tukey_of(
    means: &[f64],
    sizes: &[usize],
    mean_square_error: f64,
    error_df: f64,
) -> Result<Tukey> {
    at_least("means", means.len(), 2)?;
    check_row("means", 0, means)?;
    at_least("observations of a mean", sizes.iter().copied().min().unwrap_or(0), 1)?;
    checked("mean square of the error", mean_square_error, "positive and finite", |ms| {
        ms > 0.0 && ms.is_finite()
    })?;
    let df = degrees(error_df)?;
    let count = u32::try_from(means.len()).unwrap_or(u32::MAX);
    let pair = |first: usize, second: usize| {
        let difference = means[first] - means[second];
        let per_mean = 0.5 * ((sizes[first] as f64).recip() + (sizes[second] as f64).recip());
        let standard_error = (mean_square_error * per_mean).sqrt();
        let q = difference.abs() / standard_error;
        Ok(Pair {
            first,
            second,
            difference,
            standard_error,
            q,
            p: studentized_range_tail(q, count, df)?,
        })
    };
    let pairs = (0..means.len()).flat_map(|i| (i + 1..means.len()).map(move |j| (i, j)));
    Ok(Tukey { pairs: pairs.map(|(i, j)| pair(i, j)).collect::<Result<_>>()?, means: count, df })
}

impl Tukey {
    /// Intervals of the differences, in the order of the pairs, that contain all true differences together with a confidence
    /// such as 0.95.
    ///
    /// # Errors
    /// A confidence that is not between 0 and 1.
    pub fn intervals(&self, confidence: f64) -> Result<Vec<Interval>> {
        let q = studentized_range_quantile(1.0 - confidence, self.means, self.df)?;
        let of_pair = |pair: &Pair| {
            let half = q * pair.standard_error;
            Interval { low: pair.difference - half, high: pair.difference + half }
        };
        Ok(self.pairs.iter().map(of_pair).collect())
    }
}

//! Planned contrasts.

use super::between::one_way;
use crate::distribution::f_tail;
use crate::error::{at_least, checked};
use crate::sample::{check_equal_lengths, check_row, check_rows, mean_of, sum_of_squares, varies};
use crate::{Result, StatisticsError};

/// A comparison of means that was planned, `sum w m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contrast {
    /// Weighted sum of the means, in the data's unit.
    pub estimate: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Square of the estimate over that of the standard error, with 1 degree of freedom.
    pub f: f64,
    /// Degrees of freedom of the error.
    pub error_df: f64,
    /// Probability of this `F` or a larger one without a difference.
    pub p: f64,
    /// `F / (F + error_df)`, from 0 to 1.
    pub partial_eta_squared: f64,
}

/// Contrast of the levels of a factor within subjects: each subject's weighted sum of cells, against its own variation over the
/// subjects, so that it presupposes no sphericity. Degrees of freedom 1 and `S - 1`. `subjects` are rows of cells.
///
/// # Errors
/// Fewer than two subjects, a missing cell, another number of weights than levels, weights that are all zero or do not sum to
/// zero, a number that is not finite, or subjects that do not differ.
pub fn contrast_within<R: AsRef<[f64]>>(subjects: &[R], weights: &[f64]) -> Result<Contrast> {
    at_least("subjects", subjects.len(), 2)?;
    check_equal_lengths("subject", subjects)?;
    check_rows("subject", subjects)?;
    check_weights(weights, subjects[0].as_ref().len())?;
    let of_subject = |subject: &R| -> f64 {
        let terms = subject.as_ref().iter().zip(weights);
        terms.map(|(y, weight)| y * weight).sum()
    };
    let sums: Vec<f64> = subjects.iter().map(of_subject).collect();
    let squares = sum_of_squares(&sums);
    let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
    let cells = subjects.iter().flat_map(AsRef::as_ref);
    if !varies(squares, cells.map(|y| y * largest)) {
        return Err(StatisticsError::NoVariation { what: "the contrast over the subjects" });
    }
    let count = subjects.len() as f64;
    let df = count - 1.0;
    Contrast::new(mean_of(&sums), (squares / df / count).sqrt(), df)
}

/// Contrast of the means of groups of different subjects, against the variation within all groups; 1 and `N - k` degrees of
/// freedom.
///
/// # Errors
/// Those of [`one_way`], another number of weights than groups, or weights that are all zero or do not sum to zero.
pub fn contrast_between<R: AsRef<[f64]>>(groups: &[R], weights: &[f64]) -> Result<Contrast> {
    check_weights(weights, groups.len())?;
    let analysis = one_way(groups)?;
    let estimate = analysis.means.iter().zip(weights).map(|(m, w)| m * w).sum();
    let squares = groups.iter().zip(weights).map(|(group, w)| w * w / group.as_ref().len() as f64);
    let error = (analysis.effect.mean_square_error() * squares.sum::<f64>()).sqrt();
    Contrast::new(estimate, error, analysis.effect.error_df)
}

impl Contrast {
    fn new(estimate: f64, standard_error: f64, error_df: f64) -> Result<Self> {
        let standard_error =
            checked("standard error of the contrast", standard_error, "finite", f64::is_finite)?;
        let f = (estimate / standard_error).powi(2);
        Ok(Self {
            estimate,
            standard_error,
            f,
            error_df,
            p: f_tail(f, 1.0, error_df)?,
            partial_eta_squared: f / (f + error_df),
        })
    }
}

fn check_weights(weights: &[f64], levels: usize) -> Result<()> {
    check_row("weights", 0, weights)?;
    if weights.len() != levels {
        return Err(StatisticsError::Unbalanced {
            what: "list of weights",
            row: 0,
            count: weights.len(),
            expected: levels,
        });
    }
    let sum: f64 = weights.iter().sum();
    let size: f64 = weights.iter().map(|w| w.abs()).sum();
    checked("sum of the weights", sum, "0", |sum| sum.abs() <= 1e-12 * size)?;
    checked("largest weight", size, "other than 0", |size| size > 0.0).map(|_| ())
}

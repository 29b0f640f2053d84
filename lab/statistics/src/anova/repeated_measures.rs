//! One factor within subjects.

use super::Effect;
use super::within_effect::Projected;
use crate::Result;
use crate::error::at_least;
use crate::sample::{check_equal_lengths, check_rows, mean_of};

/// Repeated-measures analysis of variance with one factor.
#[derive(Clone, Debug, PartialEq)]
pub struct RepeatedMeasures {
    /// Mean of each level over the subjects.
    pub means: Vec<f64>,
    /// The factor, against its interaction with the subjects.
    pub effect: Effect,
    /// Sum of squares of the subjects' means.
    pub subjects_sum_of_squares: f64,
}

/// One-way repeated-measures analysis of variance of `subjects` rows with a cell for each of `a` levels:
/// `SS_A = S sum (m_a - m)²` with `a - 1` degrees of freedom against `SS_AS = sum (y_as - m_a - m_s + m)²` with
/// `(a - 1)(S - 1)`.
///
/// # Errors
/// Fewer than two subjects or levels, a missing cell, a cell that is not finite, or subjects that do not differ.
pub fn repeated_measures<R: AsRef<[f64]>>(subjects: &[R]) -> Result<RepeatedMeasures> {
    at_least("subjects", subjects.len(), 2)?;
    let levels = subjects[0].as_ref().len();
    at_least("levels", levels, 2)?;
    check_equal_lengths("subject", subjects)?;
    check_rows("subject", subjects)?;
    let all = || subjects.iter().flat_map(AsRef::as_ref).copied();
    let projection = |subject: &R| centred(subject.as_ref());
    let projections: Vec<Vec<f64>> = subjects.iter().map(projection).collect();
    let projected = Projected { groups: &[projections], cells: 1.0, df: (levels - 1) as f64 };
    let subject_means: Vec<f64> = subjects.iter().map(|s| mean_of(s.as_ref())).collect();
    let of_level = |level: usize| subjects.iter().map(move |s| s.as_ref()[level]);
    Ok(RepeatedMeasures {
        means: (0..levels)
            .map(|level| of_level(level).sum::<f64>() / subjects.len() as f64)
            .collect(),
        effect: projected.effects(all())?.effect,
        subjects_sum_of_squares: levels as f64 * crate::sample::sum_of_squares(&subject_means),
    })
}

/// A row less its mean.
pub(super) fn centred(row: &[f64]) -> Vec<f64> {
    let mean = mean_of(row);
    row.iter().map(|y| y - mean).collect()
}

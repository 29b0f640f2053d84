//! One factor between and one within subjects.

use super::Effect;
use super::between::one_way;
use super::repeated_measures::centred;
use super::within_effect::Projected;
use crate::error::at_least;
use crate::sample::{check_equal_lengths, check_rows, mean_of};
use crate::{Result, StatisticsError};

/// Split-plot analysis of variance: different subjects at the levels of one factor, each at all levels of the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitPlot {
    /// The factor between subjects, against the subjects within groups.
    pub between: Effect,
    /// The factor within subjects, against its interaction with the subjects within groups.
    pub within: Effect,
    /// The interaction of both, against the same error. Epsilon is that of the covariance pooled over the groups.
    pub interaction: Effect,
}

/// Split-plot analysis of variance of `groups[g][s][b]`: `G` groups of `n` subjects, one cell for each of `b` levels. Error of
/// the groups: the subjects' means with `G (n - 1)` degrees of freedom; error of the other two: `(b - 1) G (n - 1)`.
///
/// # Errors
/// Fewer than two groups, subjects in a group, or levels; groups of different size, a missing cell, a cell that is not finite,
/// or subjects that do not differ.
pub fn split_plot(groups: &[Vec<Vec<f64>>]) -> Result<SplitPlot> {
    at_least("groups", groups.len(), 2)?;
    at_least("subjects of a group", groups[0].len(), 2)?;
    let levels = groups[0][0].len();
    at_least("levels", levels, 2)?;
    check_equal_lengths("group", groups)?;
    let subjects: Vec<&[f64]> = groups.iter().flatten().map(Vec::as_slice).collect();
    check_equal_lengths("subject", &subjects)?;
    check_rows("subject", &subjects)?;

    let of_group = |group: &Vec<Vec<f64>>| group.iter().map(|s| mean_of(s)).collect();
    let means: Vec<Vec<f64>> = groups.iter().map(of_group).collect();
    let mut between = one_way(&means)?.effect;
    // Of the cells rather than of the subjects' means; F does not change.
    between.sum_of_squares *= levels as f64;
    between.error_sum_of_squares *= levels as f64;

    let projections: Vec<Vec<Vec<f64>>> =
        groups.iter().map(|group| group.iter().map(|subject| centred(subject)).collect()).collect();
    let projected = Projected { groups: &projections, cells: 1.0, df: (levels - 1) as f64 };
    let all = subjects.iter().flat_map(|subject| subject.iter().copied());
    let within = projected.effects(all)?;
    Ok(SplitPlot {
        between,
        within: within.effect,
        interaction: within.with_groups.ok_or(StatisticsError::TooFew {
            what: "groups",
            count: groups.len(),
            least: 2,
        })?,
    })
}

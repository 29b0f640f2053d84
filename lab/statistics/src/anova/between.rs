//! One factor between subjects.

use super::Effect;
use crate::error::at_least;
use crate::sample::{check_rows, mean_of, sum_of_squares, varies};
use crate::{Result, StatisticsError};

/// Analysis of variance of groups of different subjects.
#[derive(Clone, Debug, PartialEq)]
pub struct OneWay {
    /// Mean of each group, in the order of the groups.
    pub means: Vec<f64>,
    /// The factor, against the variation within the groups.
    pub effect: Effect,
}

/// One-way analysis of variance of groups, which may have different sizes: `SS = sum n_g (m_g - m)²` with `k - 1` degrees of
/// freedom against `sum (y - m_g)²` with `N - k`.
///
/// # Errors
/// Fewer than two groups, an empty group, no more observations than groups, an observation that is not finite, or no variation
/// within the groups.
pub fn one_way<R: AsRef<[f64]>>(groups: &[R]) -> Result<OneWay> {
    at_least("groups", groups.len(), 2)?;
    check_rows("group", groups)?;
    for group in groups {
        at_least("observations of a group", group.as_ref().len(), 1)?;
    }
    let all = || groups.iter().flat_map(AsRef::as_ref).copied();
    let count = all().count();
    at_least("observations", count, groups.len() + 1)?;
    let grand_mean = all().sum::<f64>() / count as f64;
    let means: Vec<f64> = groups.iter().map(|group| mean_of(group.as_ref())).collect();
    let of_groups = groups.iter().zip(&means).map(|(group, mean)| {
        group.as_ref().len() as f64 * (mean - grand_mean) * (mean - grand_mean)
    });
    let within: f64 = groups.iter().map(|g| sum_of_squares(g.as_ref())).sum();
    if !varies(within, all()) {
        return Err(StatisticsError::NoVariation { what: "what is observed within the groups" });
    }
    Ok(OneWay {
        effect: Effect::new(
            (of_groups.sum(), (groups.len() - 1) as f64),
            (within, (count - groups.len()) as f64),
            None,
        )?,
        means,
    })
}

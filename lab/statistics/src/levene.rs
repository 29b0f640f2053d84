//! Levene's test of equal variances.

use crate::Result;
use crate::anova::{OneWay, one_way};
use crate::sample::{check_rows, mean_of};

/// Levene's test: the one-way analysis of variance of the magnitudes of the differences from the groups' means, `|y - m_g|`
/// (Levene, 1960; from means, not medians).
///
/// # Errors
/// Those of [`one_way`]; two observations in each group always have equal magnitudes, and no variation.
pub fn levene<R: AsRef<[f64]>>(groups: &[R]) -> Result<OneWay> {
    check_rows("group", groups)?;
    let magnitudes = |group: &R| -> Vec<f64> {
        let mean = mean_of(group.as_ref());
        group.as_ref().iter().map(|y| (y - mean).abs()).collect()
    };
    one_way(&groups.iter().map(magnitudes).collect::<Vec<_>>())
}

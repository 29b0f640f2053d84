//! An effect within subjects, from each subject's projection onto the space of the effect.

use super::Effect;
use crate::sample::varies;
use crate::{Result, StatisticsError};

/// What an effect within subjects is computed from.
pub(super) struct Projected<'a> {
    /// For each group of subjects and each subject in it, the subject's cells less what other effects explain: of a factor the
    /// means of its levels less the subject's mean. It sums to zero along each factor.
    pub groups: &'a [Vec<Vec<f64>>],
    /// Number of cells in the mean of each number.
    pub cells: f64,
    /// Degrees of freedom of the effect: dimension of the projections.
    pub df: f64,
}

/// The effect and its interaction with the groups.
pub(super) struct WithinEffects {
    pub effect: Effect,
    pub with_groups: Option<Effect>,
}

impl Projected<'_> {
    /// The effect, against its interaction with the subjects within the groups, which are of equal size.
    /// `data` are all observations.
    pub(super) fn effects(&self, data: impl Iterator<Item = f64>) -> Result<WithinEffects> {
        let subjects = || self.groups.iter().flatten();
        let mean = mean_of_rows(subjects());
        let means: Vec<_> = self.groups.iter().map(|g| mean_of_rows(g.iter())).collect();
        let residuals: Vec<Vec<f64>> = (self.groups.iter().zip(&means))
            .flat_map(|(group, mean)| group.iter().map(|subject| difference(subject, mean)))
            .collect();
        let subject_count = residuals.len() as f64;
        let groups = self.groups.len() as f64;
        let error = self.cells * residuals.iter().map(|r| square(r)).sum::<f64>();
        if !varies(error, data) {
            return Err(StatisticsError::NoVariation {
                what: "the subjects' departure from an effect within them",
            });
        }
        let error = (error, self.df * (subject_count - groups));
        let epsilon = Some(epsilon(&residuals, self.df));
        let of_effect = self.cells * subject_count * square(&mean);
        let of_groups = means.iter().map(|of_group| square(&difference(of_group, &mean)));
        let of_groups = self.cells * subject_count / groups * of_groups.sum::<f64>();
        let with_groups = (self.groups.len() > 1)
            .then(|| Effect::new((of_groups, self.df * (groups - 1.0)), error, epsilon));
        Ok(WithinEffects {
            effect: Effect::new((of_effect, self.df), error, epsilon)?,
            with_groups: with_groups.transpose()?,
        })
    }
}

/// Greenhouse and Geisser's epsilon from the residuals of projections. Their scatter `S` has the same positive eigenvalues as
/// that of orthonormal contrasts of the effect, so no contrasts are needed: `tr(S)² / (df tr(S²))`.
fn epsilon(residuals: &[Vec<f64>], df: f64) -> f64 {
    let size = residuals.first().map_or(0, Vec::len);
    let scatter = |i: usize, j: usize| residuals.iter().map(|r| r[i] * r[j]).sum::<f64>();
    let trace: f64 = (0..size).map(|i| scatter(i, i)).sum();
    let squares: f64 = (0..size * size).map(|cell| scatter(cell / size, cell % size).powi(2)).sum();
    // Rounding must not make a corrected test more liberal than the uncorrected one.
    (trace * trace / (df * squares)).min(1.0)
}

fn mean_of_rows<'a>(rows: impl Iterator<Item = &'a Vec<f64>>) -> Vec<f64> {
    let (mut sums, mut count) = (Vec::new(), 0.0);
    for row in rows {
        sums.resize(row.len(), 0.0);
        sums.iter_mut().zip(row).for_each(|(sum, y)| *sum += y);
        count += 1.0;
    }
    sums.iter().map(|sum| sum / count).collect()
}

fn difference(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(a, b)| a - b).collect()
}

fn square(row: &[f64]) -> f64 {
    row.iter().map(|y| y * y).sum()
}

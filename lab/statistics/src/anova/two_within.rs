//! Two factors within subjects.

use super::Effect;
use super::repeated_measures::centred;
use super::within_effect::Projected;
use crate::Result;
use crate::error::at_least;
use crate::sample::{check_equal_lengths, check_rows, mean_of};

/// Repeated-measures analysis of variance with two factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoWithin {
    /// The first factor, against its interaction with the subjects.
    pub a: Effect,
    /// The second factor, against its interaction with the subjects.
    pub b: Effect,
    /// The interaction of both, against its interaction with the subjects.
    pub interaction: Effect,
}

/// Repeated-measures analysis of variance of `subjects[s][a][b]`, one cell for each subject and pair of levels. Each effect is
/// tested against its own interaction with the subjects; the degrees of freedom of `A x B` are `(a - 1)(b - 1)` and
/// `(a - 1)(b - 1)(S - 1)`.
///
/// # Errors
/// Fewer than two subjects or levels of a factor, a missing cell, a cell that is not finite, or subjects that do not differ in
/// an effect.
pub fn two_within(subjects: &[Vec<Vec<f64>>]) -> Result<TwoWithin> {
    at_least("subjects", subjects.len(), 2)?;
    let levels_a = subjects[0].len();
    at_least("levels of the first factor", levels_a, 2)?;
    let levels_b = subjects[0][0].len();
    at_least("levels of the second factor", levels_b, 2)?;
    check_equal_lengths("subject", subjects)?;
    let rows: Vec<&[f64]> = subjects.iter().flatten().map(Vec::as_slice).collect();
    check_equal_lengths("level of the first factor in subject x level", &rows)?;
    check_rows("level of the first factor in subject x level", &rows)?;

    let of_a = |cells: &Vec<Vec<f64>>| cells.iter().map(|row| mean_of(row)).collect::<Vec<_>>();
    let of_b = |cells: &Vec<Vec<f64>>| -> Vec<f64> {
        let of_level = |b: usize| cells.iter().map(move |row| row[b]);
        let mean = |b| of_level(b).sum::<f64>() / levels_a as f64;
        (0..levels_b).map(mean).collect()
    };
    let of_both = |cells: &Vec<Vec<f64>>| -> Vec<f64> {
        let b = centred(&of_b(cells));
        let less_both = |row: &Vec<f64>| -> Vec<f64> {
            let row = centred(row);
            row.iter().zip(&b).map(|(y, b)| y - b).collect()
        };
        cells.iter().flat_map(less_both).collect()
    };
    let effect = |projections: Vec<Vec<f64>>, cells: usize, df: usize| {
        let projected = Projected { groups: &[projections], cells: cells as f64, df: df as f64 };
        let all = rows.iter().flat_map(|row| row.iter().copied());
        Ok(projected.effects(all)?.effect)
    };
    Ok(TwoWithin {
        a: effect(subjects.iter().map(|s| centred(&of_a(s))).collect(), levels_b, levels_a - 1)?,
        b: effect(subjects.iter().map(|s| centred(&of_b(s))).collect(), levels_a, levels_b - 1)?,
        interaction: effect(
            subjects.iter().map(of_both).collect(),
            1,
            (levels_a - 1) * (levels_b - 1),
        )?,
    })
}

//! Pearson's chi-squared tests of counts, without a correction for continuity.

use crate::distribution::chi_square_tail;
use crate::error::{at_least, checked};
use crate::sample::{check_equal_lengths, check_row};
use crate::{Result, StatisticsError};

/// A chi-squared test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// `sum (observed - expected)² / expected`.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Probability of this statistic or a larger one.
    pub p: f64,
    /// Smallest expected count. Below about 5 the probability is a poor approximation.
    pub smallest_expected: f64,
}

/// Whether rows and columns of a table of counts are independent; `(rows - 1)(columns - 1)` degrees of freedom. Two experiments
/// are compared by rows such as experiment and columns such as pair.
///
/// # Errors
/// Fewer than two rows or columns, rows of different length, or a row or column without counts.
pub fn contingency<R: AsRef<[u32]>>(table: &[R]) -> Result<ChiSquare> {
    at_least("rows", table.len(), 2)?;
    check_equal_lengths("row", table)?;
    let columns = table[0].as_ref().len();
    at_least("columns", columns, 2)?;
    let sum = |counts: &mut dyn Iterator<Item = u32>| counts.map(f64::from).sum::<f64>();
    let of_row = |row: &R| sum(&mut row.as_ref().iter().copied());
    let of_rows: Vec<f64> = table.iter().map(of_row).collect();
    let of_column = |column: usize| sum(&mut table.iter().map(|row| row.as_ref()[column]));
    let of_columns: Vec<f64> = (0..columns).map(of_column).collect();
    if of_rows.iter().chain(&of_columns).any(|&sum| sum == 0.0) {
        return Err(StatisticsError::NoVariation { what: "a row or a column that has no counts" });
    }
    let total: f64 = of_rows.iter().sum();
    let cells = table.iter().zip(&of_rows).flat_map(|(row, of_row)| {
        let row = row.as_ref().iter().zip(&of_columns);
        row.map(move |(&observed, of_column)| (f64::from(observed), of_row * of_column / total))
    });
    ChiSquare::new(cells, ((table.len() - 1) * (columns - 1)) as f64)
}

/// Whether counts have given proportions, which are divided by their sum; `cells - 1` degrees of freedom.
///
/// # Errors
/// Fewer than two cells, other than one proportion a cell, a proportion that is not from 1e-100 to 1e100, or no counts.
pub fn goodness_of_fit(observed: &[u32], proportions: &[f64]) -> Result<ChiSquare> {
    at_least("cells", observed.len(), 2)?;
    if proportions.len() != observed.len() {
        return Err(StatisticsError::Unbalanced {
            what: "list of proportions",
            row: 0,
            count: proportions.len(),
            expected: observed.len(),
        });
    }
    check_row("proportions", 0, proportions)?;
    let smallest = proportions.iter().copied().fold(f64::MAX, f64::min);
    // Of a smaller one the statistic can be beyond the largest number.
    checked("smallest proportion", smallest, "at least 1e-100", |p| p >= 1e-100)?;
    let total: f64 = observed.iter().copied().map(f64::from).sum();
    at_least("counts", total as usize, 1)?;
    let parts: f64 = proportions.iter().sum();
    let cells = observed.iter().zip(proportions);
    ChiSquare::new(
        cells.map(|(&n, part)| (f64::from(n), total * part / parts)),
        (observed.len() - 1) as f64,
    )
}

impl ChiSquare {
    fn new(cells: impl Iterator<Item = (f64, f64)>, df: f64) -> Result<Self> {
        let (statistic, smallest_expected) =
            cells.fold((0.0, f64::MAX), |(sum, smallest), (observed, expected)| {
                let term = (observed - expected) * (observed - expected) / expected;
                (sum + term, expected.min(smallest))
            });
        Ok(Self { statistic, df, p: chi_square_tail(statistic, df)?, smallest_expected })
    }
}

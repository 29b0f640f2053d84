//! Predicted results beside published ones, and what the fidelity of a display is worth in per cent correct.
//!
//! The falls are those of the simulated finger on samples and on the simulated device in free exploration; the observer turns
//! them into proportions in closed form. Noise, factor of three fingers and lapses are fitted to Tables 3-3 and 3-5, the
//! factor of identification to section 4.2; everything else is predicted.

mod chapter_3;
pub mod closed_form;
mod condition;
pub mod fit;
mod identification;
pub mod published;
mod real_and_simulated;
mod rendered;
mod report;
mod text;
mod worth;

use experiment_statistics::StatisticsError;

use crate::BenchError;
use chapter_3::{
    check_table_3_3, check_table_3_5, falls_of_chapter_3, table, table_3_3, table_3_5,
};
use fit::{Cell, fit};
use identification::identification;
use published::{SECTION_4_3_C, SECTION_4_3_REPORTED_C};
use worth::worth;

pub use condition::{Condition, DisplayMode};
pub use real_and_simulated::real_against_simulated;
pub use rendered::{RenderedTouch, ToldApart, ToldApartReport, told_apart};
pub use report::{
    Basis, CellResult, Check, Falls, IdenticalResult, Identification, PairResult,
    RealAgainstSimulated, Report, TableResult, Worth,
};

/// Why nothing was predicted.
#[derive(Debug, thiserror::Error)]
pub enum PredictionError {
    /// The simulated bench.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// The answers have no correlation.
    #[error(transparent)]
    Statistics(#[from] StatisticsError),
    /// The search for the most likely observer.
    #[error("the fit failed: {0}")]
    Fit(String),
    /// An object of which no fall is known.
    #[error("object {object:?} begins with no known material; known are {}", known.join(", "))]
    UnknownMaterial {
        /// Its name.
        object: String,
        /// The materials.
        known: Vec<String>,
    },
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len();
    values.sum::<f64>() / count as f64
}

/// All predictions.
///
/// # Errors
/// The simulated bench or the fit has failed.
pub fn report() -> Result<Report, PredictionError> {
    let falls = falls_of_chapter_3()?;
    let two_hands = table_3_3(&falls);
    let [high_low, low_high] = table_3_5(&falls);
    let cells = |parts: &[&[(String, Cell)]]| -> Vec<Cell> {
        parts.iter().flat_map(|part| part.iter().map(|(_, cell)| *cell)).collect()
    };
    let find = |cells: &[Cell], fits_factor: bool| {
        fit(cells, fits_factor).map_err(|error| PredictionError::Fit(error.to_string()))
    };
    let fitted = find(&cells(&[&two_hands, &high_low, &low_high]), true)?;
    let without_table_3_5 = find(&cells(&[&two_hands]), false)?;
    let without_table_3_3 = find(&cells(&[&high_low, &low_high]), false)?;
    let three_fingers: [&[(String, Cell)]; 2] = [&high_low, &low_high];
    let (name_3_3, name_3_5) = ("Table 3-3", "Table 3-5");
    let tables = vec![
        table(name_3_3, Basis::Fitted, &fitted, &[&two_hands], check_table_3_3),
        table(name_3_5, Basis::Fitted, &fitted, &three_fingers, check_table_3_5),
        table(name_3_3, Basis::Predicted, &without_table_3_3, &[&two_hands], check_table_3_3),
        table(name_3_5, Basis::Predicted, &without_table_3_5, &three_fingers, check_table_3_5),
    ];
    let observer = fitted.observer();
    let at_gate = Condition::of_thesis(SECTION_4_3_C);
    let conditions = [
        at_gate,
        Condition::of_thesis(SECTION_4_3_REPORTED_C),
        Condition { lifts: false, ..at_gate },
        Condition { is_layered: true, ..at_gate },
    ];
    let conditions = conditions.map(|condition| real_against_simulated(&observer, condition));
    let conditions = conditions.into_iter();
    Ok(Report {
        tables,
        identification: identification(&observer)?,
        real_against_simulated: conditions.collect::<Result<_, _>>()?,
        worth: worth(&observer, &falls),
        falls,
        fitted,
        without_table_3_5,
        without_table_3_3,
    })
}

#[cfg(test)]
mod tests;

//! Tables 3-3 and 3-5: which pairs of samples are told apart.

use thermal_thesis::published::{
    ANSWERS_OF_TABLE_3_3, ANSWERS_OF_TABLE_3_5, PublishedPair, discrimination, localisation,
};

use super::PredictionError;
use super::condition::{Condition, material};
use super::fit::{Cell, CellTask, Fitted};
use super::mean;
use super::published::{SECTION_3, TABLE_3_3_MATERIALS, THRESHOLD_PERCENT};
use super::report::{Basis, CellResult, Check, Falls, TableResult};
use crate::BenchError;
use crate::falls::mean_fall_k;

/// Falls on samples of sections 3.2 and 3.3.
///
/// # Errors
/// The simulated plant does not accept a value.
pub fn falls_of_chapter_3() -> Result<Falls, PredictionError> {
    let setup = Condition::of_thesis(SECTION_3).setup();
    let names = TABLE_3_3_MATERIALS.iter().chain(&["granite"]);
    let falls_k: Result<Vec<_>, BenchError> =
        names.map(|name| Ok(((*name).to_owned(), mean_fall_k(&setup, material(name)?)?))).collect();
    Ok(Falls { skin_room_c: SECTION_3, falls_k: falls_k? })
}

/// Cells of Table 3-3 with their labels.
pub(super) fn table_3_3(falls: &Falls) -> Vec<(String, Cell)> {
    let cell = |pair: PublishedPair| {
        let cell = Cell {
            task: CellTask::Colder([falls.of(&pair.first), falls.of(&pair.second)]),
            published: pair.percent / 100.0,
            trials: ANSWERS_OF_TABLE_3_3,
        };
        (format!("{} - {}", pair.first, pair.second), cell)
    };
    discrimination().into_iter().map(cell).collect()
}

/// Cells of Table 3-5: those whose target is the colder, and those whose target is the warmer.
pub(super) fn table_3_5(falls: &Falls) -> [Vec<(String, Cell)>; 2] {
    let cell = |pair: PublishedPair| {
        let cell = Cell {
            task: CellTask::Different(falls.of(&pair.first), falls.of(&pair.second)),
            published: pair.percent / 100.0,
            trials: ANSWERS_OF_TABLE_3_5,
        };
        (format!("{} among {}", pair.first, pair.second), cell)
    };
    let is_colder = |pair: &PublishedPair| falls.of(&pair.first) > falls.of(&pair.second);
    let (high_low, low_high): (Vec<_>, Vec<_>) = localisation().into_iter().partition(is_colder);
    [high_low, low_high].map(|rows| rows.into_iter().map(cell).collect())
}

pub(super) fn table(
    name: &str,
    basis: Basis,
    fitted: &Fitted,
    cells: &[&[(String, Cell)]],
    checks: impl FnOnce(&TableResult, &[f64]) -> Vec<Check>,
) -> TableResult {
    let observer = fitted.observer();
    let result = |(label, cell): &(String, Cell)| CellResult {
        label: label.clone(),
        published: 100.0 * cell.published,
        predicted: 100.0 * cell.predicted(&observer),
    };
    let parts: Vec<Vec<CellResult>> =
        cells.iter().map(|part| part.iter().map(result).collect()).collect();
    let part_means: Vec<f64> =
        parts.iter().map(|part| mean(part.iter().map(|cell| cell.predicted))).collect();
    let cells: Vec<CellResult> = parts.into_iter().flatten().collect();
    let mut table = TableResult {
        name: name.into(),
        basis,
        observer: format!(
            "s0 {:.2} K, w {:.3}, three fingers {:.2}, lapses {:.3}",
            fitted.s0_k, fitted.w, fitted.three_finger_factor, fitted.lapse
        ),
        rms: mean(cells.iter().map(|cell| (cell.predicted - cell.published).powi(2))).sqrt(),
        mean_published: mean(cells.iter().map(|cell| cell.published)),
        mean_predicted: mean(cells.iter().map(|cell| cell.predicted)),
        cells,
        checks: Vec::new(),
    };
    table.checks = checks(&table, &part_means);
    table
}

pub(super) fn check_table_3_3(table: &TableResult, _parts: &[f64]) -> Vec<Check> {
    let allowed =
        ["copper - bronze", "copper - stainless-steel", "bronze - stainless-steel", "g10 - abs"];
    let below: Vec<&str> = (table.cells.iter())
        .filter(|cell| cell.predicted < THRESHOLD_PERCENT)
        .map(|cell| cell.label.as_str())
        .collect();
    vec![
        Check::at_most("rms", table.rms, 9.0),
        Check::within("mean", table.mean_predicted, 84.0, 93.0),
        Check {
            what: "pairs below 72 %".into(),
            value: below.join(", "),
            allowed: format!("among {}", allowed.join(", ")),
            met: below.iter().all(|pair| allowed.contains(pair)),
        },
    ]
}

pub(super) fn check_table_3_5(table: &TableResult, parts: &[f64]) -> Vec<Check> {
    let [high_low, low_high] = [0, 1].map(|part| parts.get(part).copied().unwrap_or(0.0));
    vec![
        Check::at_most("rms", table.rms, 10.0),
        Check::within("mean", table.mean_predicted, 50.0, 60.0),
        Check {
            what: "mean with a colder target against that with a warmer one".into(),
            value: format!("{high_low:.1} and {low_high:.1} %"),
            allowed: "larger (published: 61.5 and 51.5 %)".into(),
            met: high_low > low_high,
        },
    ]
}

//! The rows and figures as JSON.

use serde::Serialize;

use super::figure::FigureDifference;
use super::{Chapter, Counts};

/// The object that `--json` prints.
#[derive(Serialize)]
pub struct Json<'a> {
    counts: Counts,
    rows: Vec<JsonRow<'a>>,
    /// Differences of the model figures between the plant's finite volumes and the closed forms.
    figures: &'a [FigureDifference],
}

#[derive(Serialize)]
struct JsonRow<'a> {
    chapter: u8,
    place: &'a str,
    quantity: &'a str,
    unit: &'a str,
    stated: String,
    computed: f64,
    verdict: &'static str,
    /// Computed minus stated, or minus the limit next to it; null where no number is stated.
    difference: Option<f64>,
    remark: Option<String>,
}

/// Collects the object that `--json` prints.
#[must_use]
pub fn json<'a>(chapters: &'a [Chapter], figures: &'a [FigureDifference]) -> Json<'a> {
    let rows = chapters.iter().flat_map(|chapter| {
        chapter.rows.iter().map(|row| JsonRow {
            chapter: chapter.number,
            place: row.place,
            quantity: &row.quantity,
            unit: row.unit,
            stated: row.stated.to_string(),
            computed: row.computed,
            verdict: row.verdict().word(),
            difference: row.stated.difference(row.computed),
            remark: Some(row.remark_text()).filter(|remark| !remark.is_empty()),
        })
    });
    Json {
        counts: Counts::of(chapters),
        rows: rows.collect(),
        figures,
    }
}

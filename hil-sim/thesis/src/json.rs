//! The rows and figures as JSON.

use serde::Serialize;

use super::figure::FigureDifference;
use super::measured::{Measurement, VARIANTS};
use super::{Chapter, Counts};

/// The object that `--json` prints.
#[derive(Serialize)]
pub struct Json<'a> {
    counts: Counts,
    rows: Vec<JsonRow<'a>>,
    /// Differences of the model figures between the plant's finite volumes and the closed forms.
    figures: &'a [FigureDifference],
    /// Measurements of the thesis beside the plant.
    measured: Vec<JsonMeasurement<'a>>,
}

#[derive(Serialize)]
struct JsonMeasurement<'a> {
    place: &'a str,
    quantity: &'a str,
    unit: &'a str,
    measured: String,
    /// Empty if the plant has no such quantity.
    plant: Vec<JsonPlant>,
    verdict: &'static str,
    /// Why the plant does not show it, or not with Eq. 6-8 alone.
    why: Option<&'a str>,
}

#[derive(Serialize)]
struct JsonPlant {
    finger: &'static str,
    contact: &'static str,
    value: f64,
    agrees: bool,
}

impl<'a> JsonMeasurement<'a> {
    fn new(measurement: &'a Measurement) -> Self {
        let values = measurement.plant.iter().flatten();
        let plant = VARIANTS.iter().zip(values).map(|(variant, &value)| JsonPlant {
            finger: variant.finger(),
            contact: variant.contact(),
            value,
            agrees: measurement.measured.agrees(value),
        });
        Self {
            place: measurement.place,
            quantity: &measurement.quantity,
            unit: measurement.unit,
            measured: measurement.measured.to_string(),
            plant: plant.collect(),
            verdict: measurement.shown().word(),
            why: Some(measurement.why()).filter(|why| !why.is_empty()),
        }
    }
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
pub fn json<'a>(
    chapters: &'a [Chapter],
    figures: &'a [FigureDifference],
    measured: &'a [Measurement],
) -> Json<'a> {
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
        measured: measured.iter().map(JsonMeasurement::new).collect(),
    }
}

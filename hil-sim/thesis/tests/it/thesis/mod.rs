//! The recomputed thesis: verdicts, known errors of the thesis, and golden values.

mod figures;
mod known;
mod measured;
mod rows;
mod verdicts;

use serde::de::DeserializeOwned;
use thermal_thesis::chapters;
use thermal_thesis::row::Row;

fn table<T: DeserializeOwned>(text: &str) -> Vec<T> {
    let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
    rows.collect::<Result<_, _>>().expect("a golden table")
}

fn all_rows() -> Vec<Row> {
    chapters().into_iter().flat_map(|chapter| chapter.rows).collect()
}

fn computed(place: &str, quantity: &str) -> f64 {
    let rows = all_rows();
    let mut found = rows.iter().filter(|row| row.place == place && row.quantity == quantity);
    let row = found.next().unwrap_or_else(|| panic!("no row {place}, {quantity}"));
    assert_eq!(found.next(), None, "{place}, {quantity} twice");
    row.computed
}

/// Names of the materials in golden tables and in rows.
const NAMES: [(&str, &str); 9] = [
    ("copper", "copper"),
    ("bronze", "bronze"),
    ("stainless-steel", "stainless steel"),
    ("granite", "granite"),
    ("g10", "G10"),
    ("abs", "ABS"),
    ("foam", "foam"),
    ("baf2", "BaF2"),
    ("zns", "ZnS"),
];

fn name(golden: &str) -> &'static str {
    let found = NAMES.iter().find(|(key, _)| *key == golden);
    found.unwrap_or_else(|| panic!("material {golden}")).1
}

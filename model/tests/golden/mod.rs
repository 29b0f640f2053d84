//! Reference values computed with 30 digits, independently of this crate.

use std::collections::HashMap;

/// Rows of a golden table, as column name to text.
pub fn rows(name: &str) -> Vec<HashMap<String, String>> {
    let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let rows = csv::Reader::from_path(&path)
        .expect("golden table")
        .into_deserialize();
    rows.collect::<Result<_, _>>().expect("golden row")
}

/// A number of a row.
pub fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column} is {:?}", row[column]))
}

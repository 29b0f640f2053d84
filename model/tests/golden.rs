//! Golden values: the equations of the thesis with 30 digits, computed by `data/generate.py` independently of this
//! crate. `budgets` compares the crate with them.

use contact_model::material::{Material, find};
use documented_figures::run_generator;
use std::collections::HashMap;

/// A row of a golden table, as column name to text.
pub type Row = HashMap<String, String>;

pub fn rows(name: &str) -> Vec<Row> {
    let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let rows = csv::Reader::from_path(&path).expect("golden table").into_deserialize();
    rows.collect::<Result<_, _>>().expect("golden row")
}

/// The number in a column of a row.
pub fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} is {:?}", row[column]))
}

pub fn material(row: &Row) -> &'static Material {
    find(&row["material"]).expect("material of the thesis")
}

#[test]
fn committed_golden_values_are_those_that_the_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/generate.py");
    run_generator(script, &["--check"]);
}

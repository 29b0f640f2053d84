//! Tests with records made by hand, whose results are known.

mod any_records;
mod data;
mod documents;
mod known;
mod left_out;
mod participants;
mod verdicts;

use crate::report::{Cell, Section, Table, TaskAnalysis};

impl TaskAnalysis {
    fn section(&self, name: &str) -> &Section {
        let found = self.sections.iter().find(|section| section.name == name);
        found.unwrap_or_else(|| panic!("no section {name}"))
    }

    fn table(&self, name: &str) -> &Table {
        let mut tables = self.sections.iter().flat_map(|section| &section.tables);
        let found = tables.find(|table| table.name == name);
        found.unwrap_or_else(|| panic!("no table {name}"))
    }

    /// All sentences on what is not possible.
    fn not_possible(&self) -> Vec<&str> {
        let sentences = self.sections.iter().flat_map(|section| &section.not_possible);
        sentences.map(String::as_str).collect()
    }

    /// The warnings of a section.
    fn warnings(&self, section: &str) -> Vec<&str> {
        self.section(section).warnings.iter().map(String::as_str).collect()
    }
}

impl Table {
    /// The cell of a column in the first row that begins with these words.
    fn cell(&self, begin: &[&str], column: &str) -> &Cell {
        let begins = |row: &&Vec<Cell>| {
            begin.iter().zip(row.iter()).all(|(word, cell)| *cell == Cell::from(*word))
        };
        let row = self.rows.iter().find(begins);
        let row = row.unwrap_or_else(|| panic!("no row {begin:?} in {}", self.name));
        let index = self.columns.iter().position(|one| one.name == column);
        &row[index.unwrap_or_else(|| panic!("no column {column} in {}", self.name))]
    }

    fn number(&self, begin: &[&str], column: &str) -> f64 {
        match self.cell(begin, column) {
            Cell::Number(number) => *number,
            Cell::Count(count) => *count as f64,
            other => panic!("{column} of {begin:?} in {} is {other:?}", self.name),
        }
    }
}

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
}

//! What an analysis gives: sections with tables, pictures and sentences.

use serde::{Serialize, Serializer};

/// The analysis of a data set.
#[derive(Clone, Debug, Serialize)]
pub struct Analysis {
    /// Files and folders that were not analysed, and why.
    pub left_out: Vec<String>,
    /// Each task of the data set, in the order of their names.
    pub tasks: Vec<TaskAnalysis>,
}

/// The analysis of one task over all its participants.
#[derive(Clone, Debug, Serialize)]
pub struct TaskAnalysis {
    /// Name of the task; where its session files differ, with a number for each of them.
    pub task: String,
    /// Title of the session.
    pub title: String,
    /// Where the experiment comes from.
    pub cite: String,
    /// What the participants were asked.
    pub question: Option<String>,
    /// Codes of the participants.
    pub participants: Vec<String>,
    /// Whether some or all participants were simulated.
    pub is_simulated: bool,
    /// What was found, in the order of the page.
    pub sections: Vec<Section>,
}

/// Part of an analysis: what one word of the session file asks for, or what every analysis has.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    /// The word.
    pub name: String,
    /// Its heading.
    pub title: String,
    /// How it was computed and how to read it.
    pub notes: Vec<String>,
    /// What is not in its tables, and which of their numbers are poor approximations.
    pub warnings: Vec<String>,
    /// What could not be computed, and why.
    pub not_possible: Vec<String>,
    /// Its tables.
    pub tables: Vec<Table>,
    /// Its pictures; data are in the tables.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
}

impl Section {
    pub(crate) fn new(name: &str, title: &str) -> Self {
        Self {
            name: name.into(),
            title: title.into(),
            notes: Vec::new(),
            warnings: Vec::new(),
            not_possible: Vec::new(),
            tables: Vec::new(),
            pictures: Vec::new(),
        }
    }

    pub(crate) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds warnings that are not there yet.
    pub(crate) fn warn(&mut self, warnings: impl IntoIterator<Item = String>) {
        for warning in warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Notes that `what` has no value because of `why`.
    pub(crate) fn lacks(&mut self, what: &str, why: impl std::fmt::Display) {
        self.not_possible.push(format!("{what}: {why}"));
    }

    /// Adds a table, unless it has no rows.
    pub(crate) fn add(&mut self, table: Table) {
        if !table.rows.is_empty() {
            self.tables.push(table);
        }
    }

    /// Adds a picture.
    pub(crate) fn draw(&mut self, caption: impl Into<String>, svg: anyhow::Result<String>) {
        match svg {
            Ok(svg) => self.pictures.push(Picture { caption: caption.into(), svg }),
            Err(error) => self.lacks(&format!("Picture \"{}\"", caption.into()), error),
        }
    }
}

/// A picture.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it shows.
    pub caption: String,
    /// An SVG document.
    pub svg: String,
}

/// A table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Its name, of letters, digits and hyphens.
    pub name: String,
    /// What it shows, and what its `n` counts.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, a cell for each column.
    pub rows: Vec<Vec<Cell>>,
    /// Whether the page shows it only when it is opened.
    #[serde(skip)]
    pub(crate) is_folded: bool,
}

impl Table {
    pub(crate) fn new(
        name: &str,
        caption: &str,
        columns: impl IntoIterator<Item = Column>,
    ) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            columns: columns.into_iter().collect(),
            rows: Vec::new(),
            is_folded: false,
        }
    }

    /// A long table, which the page shows only when it is opened.
    pub(crate) fn folded(mut self) -> Self {
        self.is_folded = true;
        self
    }

    pub(crate) fn row(&mut self, mut cells: Vec<Cell>) {
        debug_assert_eq!(cells.len(), self.columns.len(), "cells of a row of {}", self.name);
        for (cell, column) in cells.iter_mut().zip(&self.columns) {
            cell.drop_rounding_error(column.shown);
        }
        self.rows.push(cells);
    }
}

/// A column of a table.
#[derive(Clone, Debug, Serialize)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit; empty without one.
    pub unit: &'static str,
    #[serde(skip)]
    pub(crate) shown: Shown,
}

/// How the page shows the numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// As they are.
    Plain,
    /// With this many decimals.
    Decimals(usize),
    /// As a probability.
    Probability,
}

/// A column of words or counts.
pub(crate) fn words(name: impl Into<String>) -> Column {
    Column { name: name.into(), unit: "", shown: Shown::Plain }
}

/// A column of numbers with this many decimals.
pub(crate) fn numbers(name: impl Into<String>, unit: &'static str, decimals: usize) -> Column {
    Column { name: name.into(), unit, shown: Shown::Decimals(decimals) }
}

/// A column of probabilities.
pub(crate) fn probabilities(name: impl Into<String>) -> Column {
    Column { name: name.into(), unit: "", shown: Shown::Probability }
}

/// A cell of a table. A number is finite.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// No value.
    Nothing,
    /// Words.
    Text(String),
    /// A count.
    Count(u64),
    /// A number.
    Number(f64),
}

/// Size below which a number is the rounding error of differences that are zero, in every unit of the tables. Probabilities may be
/// smaller.
const ROUNDING_ERROR: f64 = 1e-12;

impl Cell {
    /// Makes a rounding error zero.
    fn drop_rounding_error(&mut self, shown: Shown) {
        if let Self::Number(number) = self
            && shown != Shown::Probability
            && number.abs() < ROUNDING_ERROR
        {
            *number = 0.0;
        }
    }
}

/// A number with seven significant digits and without a negative zero, as files have it: a millisecond of a session of two hours, and more than any
/// measurement or probability here is good for.
pub(crate) fn rounded(number: f64) -> f64 {
    format!("{number:.6e}").parse().unwrap_or(number) + 0.0
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Nothing => serializer.serialize_none(),
            Self::Text(text) => serializer.serialize_str(text),
            Self::Count(count) => serializer.serialize_u64(*count),
            Self::Number(number) => serializer.serialize_f64(rounded(*number)),
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        if number.is_finite() { Self::Number(number) } else { Self::Nothing }
    }
}

impl From<u32> for Cell {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

/// A row of cells.
macro_rules! cells {
    ($($value:expr),* $(,)?) => { vec![$($crate::report::Cell::from($value)),*] };
}
pub(crate) use cells;

//! Designs of analyses of variance that the data of a task have.

use super::{confusion, falls, force, magnitudes, oddity, pairs, same_different};
use crate::cells::{Cells, mean};
use crate::input::Task;

/// One dependent variable by one or two factors within participants.
#[derive(Clone, Debug)]
pub struct Design {
    /// The dependent variable, with unit, and what it was taken from.
    pub dependent: String,
    /// Factors with their levels; the cells have the levels of the last factor next to each other.
    pub factors: Vec<(String, Vec<String>)>,
    pub cells: Cells,
    pub contrast: Contrast,
    /// Factors and levels that were presented and are not in the cells, because nobody has a value there.
    pub dropped: Vec<(String, String)>,
}

/// Contrasts that were planned for the first factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contrast {
    None,
    /// Each level against the mean of all.
    Mean,
    /// Each level against the first one.
    First,
}

impl Design {
    /// One factor.
    pub fn one<L: PartialEq + ToString>(
        dependent: impl Into<String>,
        factor: &str,
        levels: &[L],
        observations: &[(usize, L, f64)],
    ) -> Self {
        let levels_text = levels.iter().map(ToString::to_string).collect();
        Self {
            dependent: dependent.into(),
            factors: vec![(factor.into(), levels_text)],
            cells: Cells::new(levels, observations),
            contrast: Contrast::None,
            dropped: Vec::new(),
        }
    }

    /// Two factors.
    pub fn two(
        dependent: impl Into<String>,
        (first, firsts): (&str, &[String]),
        (second, seconds): (&str, &[String]),
        observations: &[(usize, (String, String), f64)],
    ) -> Self {
        let crossed =
            firsts.iter().flat_map(|a| seconds.iter().map(move |b| format!("{a}\u{1f}{b}")));
        let levels: Vec<String> = crossed.collect();
        let joined: Vec<_> = observations
            .iter()
            .map(|(participant, (a, b), value)| (*participant, format!("{a}\u{1f}{b}"), *value))
            .collect();
        Self {
            dependent: dependent.into(),
            factors: vec![(first.into(), firsts.to_vec()), (second.into(), seconds.to_vec())],
            cells: Cells::new(&levels, &joined),
            contrast: Contrast::None,
            dropped: Vec::new(),
        }
    }

    pub fn with(mut self, contrast: Contrast) -> Self {
        self.contrast = contrast;
        self
    }

    /// Notes the levels of a factor that were presented and are not in the cells.
    pub fn without<L: AsRef<str>>(
        mut self,
        factor: &str,
        presented: impl IntoIterator<Item = L>,
    ) -> Self {
        let there = self.factors.iter().find(|(name, _)| name == factor);
        let there = there.map_or(Vec::new(), |(_, levels)| levels.clone());
        for level in presented {
            let level = level.as_ref();
            let dropped = (factor.to_owned(), level.to_owned());
            if !there.iter().any(|one| one == level) && !self.dropped.contains(&dropped) {
                self.dropped.push(dropped);
            }
        }
        self
    }

    /// The cells of one factor alone, means over the levels of the other.
    pub fn marginal(&self, factor: usize) -> Option<Marginal<'_>> {
        let (name, levels) = self.factors.get(factor)?;
        let seconds = self.factors.get(1).map(|(_, seconds)| seconds.len());
        let row = |row: &Vec<f64>| -> Vec<f64> {
            let Some(seconds) = seconds else {
                return row.clone();
            };
            let level = |level: usize| {
                let cells = row.iter().enumerate().filter(move |(cell, _)| match factor {
                    0 => cell / seconds == level,
                    _ => cell % seconds == level,
                });
                mean(cells.map(|(_, value)| *value))
            };
            (0..levels.len()).filter_map(level).collect()
        };
        Some(Marginal { factor: name, levels, rows: self.cells.rows.iter().map(row).collect() })
    }
}

/// The cells of one factor.
pub struct Marginal<'a> {
    pub factor: &'a str,
    pub levels: &'a [String],
    /// A row for each participant.
    pub rows: Vec<Vec<f64>>,
}

/// The designs within participants, of what the session file asks for.
pub fn within(task: &Task) -> Vec<Design> {
    let mut designs = Vec::new();
    if task.asks_for("pairs-by-mode") {
        designs.push(pairs::by_mode_design(task));
    } else if task.asks_for("pairs") {
        designs.push(pairs::design(task));
    }
    if task.asks_for("same-different") {
        designs.push(same_different::design(task));
    }
    if task.asks_for("oddity") {
        designs.extend(oddity::designs(task));
    }
    if task.asks_for("confusion") {
        designs.extend(confusion::designs(task));
    }
    if task.asks_for("force-matching") {
        designs.extend(force::designs(task));
    } else if task.asks_for("falls") {
        designs.extend(falls::designs(task));
    }
    if task.asks_for("magnitudes") {
        designs.push(magnitudes::design(task));
    }
    designs
}

/// The designs with the parts of the session as one factor; the parts are the first factor.
pub fn of_parts(task: &Task) -> Vec<Design> {
    let mut designs = Vec::new();
    if task.asks_for("confusion") {
        designs.push(confusion::design_of_parts(task));
    }
    if task.asks_for("falls") {
        designs.push(falls::design_of_parts(task));
    }
    if task.asks_for("pairs") {
        designs.push(pairs::design_of_parts(task));
    }
    designs
}

//! The netlists of `hardware/`, with their parameters.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::number;

/// Files of the folder `hardware/`, in the order in which decks include them.
pub const FILES: [&str; 14] = [
    "parts",
    "dividers",
    "comparator",
    "supply",
    "switch",
    "bridge",
    "mirror",
    "force",
    "flux",
    "ground",
    "leakage",
    "multiplexer",
    "parity",
    "stop_relay",
];

/// The folder of the netlists.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new(".")).into()
}

/// The text of all netlists. A bench changes a copy: another value of a parameter, or another line.
#[derive(Clone, Debug)]
pub struct Netlists {
    lines: Vec<String>,
}

impl Netlists {
    /// Reads the files.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn load() -> Result<Self> {
        let mut lines = Vec::new();
        for name in FILES {
            let path = folder().join(name).with_extension("cir");
            let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
            lines.extend(text.lines().map(str::to_owned));
        }
        Ok(Self { lines })
    }

    /// Netlists of this text.
    pub fn from_text(text: &str) -> Self {
        Self { lines: text.lines().map(str::to_owned).collect() }
    }

    /// All lines, for a deck.
    pub fn text(&self) -> String {
        self.lines.join("\n")
    }

    /// Names and values of all parameters.
    pub fn params(&self) -> impl Iterator<Item = (&str, f64)> {
        self.lines.iter().filter_map(|line| param(line))
    }

    /// The value of a parameter.
    ///
    /// # Errors
    /// There is no `.param` line of this name with a number.
    pub fn param(&self, name: &str) -> Result<f64> {
        self.params()
            .find(|(found, _)| *found == name)
            .map(|(_, value)| value)
            .with_context(|| format!("the netlists have no parameter {name}"))
    }

    /// A copy in which a parameter has another value.
    ///
    /// # Errors
    /// There is no parameter of this name.
    pub fn with(&self, name: &str, value: f64) -> Result<Self> {
        self.param(name)?;
        let mut changed = self.clone();
        for line in &mut changed.lines {
            if param(line).is_some_and(|(found, _)| found == name) {
                *line = format!(".param {name}={value:e}");
            }
        }
        Ok(changed)
    }

    /// A copy in which a parameter is multiplied by a factor.
    ///
    /// # Errors
    /// There is no parameter of this name.
    pub fn scaled(&self, name: &str, factor: f64) -> Result<Self> {
        self.with(name, self.param(name)? * factor)
    }

    /// A copy in which the only line that begins with `start` is replaced by `line`.
    ///
    /// # Errors
    /// No line or several lines begin so.
    pub fn with_line(&self, start: &str, line: &str) -> Result<Self> {
        let mut changed = self.clone();
        let mut found = changed.lines.iter_mut().filter(|old| old.starts_with(start));
        let old = found.next().with_context(|| format!("no line begins with {start:?}"))?;
        ensure!(found.next().is_none(), "several lines begin with {start:?}");
        *old = line.to_owned();
        Ok(changed)
    }
}

/// Name and value of a line `.param NAME=VALUE`, perhaps with a comment after `;`.
fn param(line: &str) -> Option<(&str, f64)> {
    let (line, _) = line.split_once(';').unwrap_or((line, ""));
    let (name, value) = line.strip_prefix(".param ")?.split_once('=')?;
    Some((name.trim(), number::parse(value)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "* title\n.param r_in=4.7k ; filter\n.param c_in=100n\nR1 a b {r_in}\nR10 a b 1k";

    #[test]
    fn a_parameter_is_read_and_changed_in_a_copy() {
        let netlists = Netlists::from_text(TEXT);
        assert_eq!(netlists.param("r_in").unwrap(), 4.7e3);
        let changed = netlists.scaled("r_in", 2.0).unwrap();
        assert_eq!(changed.param("r_in").unwrap(), 9.4e3);
        assert_eq!(changed.param("c_in").unwrap(), netlists.param("c_in").unwrap());
        assert!(netlists.with("r_out", 1.0).is_err());
    }

    #[test]
    fn only_an_unambiguous_line_is_replaced() {
        let netlists = Netlists::from_text(TEXT);
        let changed = netlists.with_line("R1 a", "R1 a b 1g").unwrap();
        assert!(changed.text().contains("R1 a b 1g\nR10 a b 1k"));
        assert!(netlists.with_line("R1", "").is_err());
        assert!(netlists.with_line("C1", "").is_err());
    }

    #[test]
    fn every_value_of_the_repository_is_stated_once() {
        let netlists = Netlists::load().unwrap();
        let mut names: Vec<_> = netlists.params().map(|(name, _)| name).collect();
        names.sort_unstable();
        let count = names.len();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(count > 40);
    }
}

//! The text of a scene, and errors that point into it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thermal_client::text::escaped_text;
use thermal_plant::Params;
use thermal_plant::parameters;

use super::file::Number;

/// An error in a scene: file, line and problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    file: PathBuf,
    line: Option<usize>,
    problem: String,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", escaped_text(&self.problem))
    }
}

impl std::error::Error for SceneError {}

impl SceneError {
    pub(super) fn unreadable(file: &Path, error: &std::io::Error) -> Self {
        Self { file: file.into(), line: None, problem: format!("cannot be read: {error}") }
    }
}

/// The text of a scene and its file.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    pub fn error(&self, span: Option<Range<usize>>, problem: impl Into<String>) -> SceneError {
        let line = span.map(|span| {
            let before = self.text.as_bytes().iter().take(span.start);
            before.filter(|byte| **byte == b'\n').count() + 1
        });
        SceneError { file: self.file.into(), line, problem: problem.into() }
    }

    /// The problem of a value of the wrong type or word by key, value and what is allowed, as other problems are told, from the
    /// file reader's words; `None` if its error is about something else than a value on the line of its key.
    pub fn wrong_value(&self, span: Option<Range<usize>>, problem: &str) -> Option<String> {
        let of_values = ["invalid type: ", "invalid value: ", "unknown variant ", "expected "];
        if !of_values.iter().any(|start| problem.starts_with(start)) {
            return None;
        }
        let (span, (_, allowed)) = (span?, problem.split_once("expected ")?);
        let (value, before) = (self.text.get(span.clone())?, self.text.get(..span.start)?);
        let (key, _) = before.rsplit('\n').next()?.rsplit_once('=')?;
        if key.contains(['{', '[']) || value.contains('\n') {
            return None;
        }
        let tables = before.lines().rev().filter_map(|line| {
            let header = line.trim().strip_prefix('[')?.trim_start_matches('[');
            header.split(']').next()
        });
        let path: Vec<_> = (tables.take(1).chain([key])).map(str::trim).collect();
        Some(format!("{} = {value}; allowed is {allowed}", path.join(".")))
    }

    /// The number, if it lies within the range.
    pub fn within(
        &self,
        key: &str,
        number: &Number,
        least: f64,
        most: f64,
    ) -> Result<f64, SceneError> {
        let value = *number.get_ref();
        if (least..=most).contains(&value) {
            return Ok(value);
        }
        let problem = format!("{key} = {value}; allowed is {least} to {most}");
        Err(self.error(Some(number.span()), problem))
    }

    /// The number, if it lies within the range; `default` if the scene gives none.
    pub fn within_or(
        &self,
        default: f64,
        key: &str,
        number: &Option<Number>,
        min: f64,
        max: f64,
    ) -> Result<f64, SceneError> {
        match number {
            Some(number) => self.within(key, number, min, max),
            None => Ok(default),
        }
    }

    pub fn time(&self, key: &str, number: &Number, duration_s: f64) -> Result<f64, SceneError> {
        self.within(key, number, 0.0, duration_s)
    }

    /// Sets a plant parameter.
    pub fn set(
        &self,
        params: &mut Params,
        key: &str,
        value: f64,
        span: Range<usize>,
    ) -> Result<(), SceneError> {
        parameters::set(params, key, value)
            .map_err(|error| self.error(Some(span), error.to_string()))
    }
}

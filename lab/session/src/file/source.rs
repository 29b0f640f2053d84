//! The text of a session file, and errors that point into it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thermal_client::text::escaped_text;

/// An error in a session file: file, line and problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SessionError {
    file: PathBuf,
    line: Option<usize>,
    problem: String,
}

impl SessionError {
    /// An error of the file as a whole.
    pub(super) fn of_file(file: &Path, problem: impl Into<String>) -> Self {
        Self { file: file.into(), line: None, problem: problem.into() }
    }

    /// The line, from 1; `None` if the error is one of the whole file.
    pub const fn line(&self) -> Option<usize> {
        self.line
    }

    /// What is wrong, and what is allowed.
    pub fn problem(&self) -> &str {
        &self.problem
    }
}

impl fmt::Display for SessionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", escaped_text(&self.problem))
    }
}

impl std::error::Error for SessionError {}

/// The text of a session and its file.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    /// An error at a byte of the text.
    pub fn error(&self, at: usize, problem: impl Into<String>) -> SessionError {
        let before = self.text.as_bytes().iter().take(at);
        SessionError {
            file: self.file.into(),
            line: Some(before.filter(|byte| **byte == b'\n').count() + 1),
            problem: problem.into(),
        }
    }

    /// The text of a value, as an error quotes it: its first line, and not all of a long one.
    pub fn quote(&self, span: Range<usize>) -> String {
        const MOST_CHARACTERS: usize = 60;
        let text = self.text.get(span).unwrap_or_default();
        let first = text.lines().next().unwrap_or_default();
        let quoted: String = first.chars().take(MOST_CHARACTERS).collect();
        if quoted.len() < text.len() { quoted + " …" } else { quoted }
    }
}

//! The line protocol between host and device.

mod line;
mod telemetry;

pub use line::{Line, LineError, LineReader};
pub use telemetry::Telemetry;

use core::fmt;

/// A command of the host, checked and ready to execute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// `id`: who is there.
    Identify,
}

/// What a command is answered with; `Display` writes the line without its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reply;

/// Why a line was refused; `Display` writes the line without its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Error;

impl Command {
    /// Reads one line. Does the costly part of a command, so that executing it is short.
    pub fn parse(_line: &str) -> Result<Self, Error> {
        Ok(Self::Identify)
    }
}

impl From<LineError> for Error {
    fn from(_error: LineError) -> Self {
        Self
    }
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ok")
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("error")
    }
}

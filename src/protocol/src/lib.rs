//! The line protocol between host and device: one line of words to the device, one line back.
//!
//! Answers start with `ok` or `err`, streamed telemetry with `T`.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod address;
mod command;
mod commissioning;
mod error;
mod handler;
mod line;
mod reply;
mod telemetry;
mod text;

pub use command::Parsed;
pub use error::{Error, Reason, Word};
pub use handler::{Desk, Execute, Executed};
pub use line::{ANSWER_MAX, LINE_MAX, Line, LineError, LineReader};
pub use reply::Reply;
pub use telemetry::{TelemetryLine, telemetry_line};

#[cfg(test)]
mod tests;

//! The line protocol between host and device: one line of words to the device, one line back.
//!
//! Answers start with `ok` or `err`, streamed telemetry with `T`.

mod address;
mod command;
mod error;
mod line;
mod reply;
mod telemetry;
mod text;

pub(crate) use address::address;
pub use address::{Addressed, Request};
pub use command::Command;
pub(crate) use command::number;
pub use error::{Error, Number, Reason, Word};
pub use line::{ANSWER_MAX, LINE_MAX, Line, LineError, LineReader};
pub use reply::{Reply, Setting, Status};
pub use telemetry::Telemetry;

#[cfg(test)]
mod tests;

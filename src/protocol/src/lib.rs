#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod address;
mod arguments;
mod command;
mod commissioning_commands;
mod error;
mod handler;
mod line_buffer;
mod line_reader;
mod reply;
mod telemetry;

pub use command::Request;
pub use error::{Error, StorageFailureText, WordExcerpt};
pub use handler::{CommandHandler, ExecuteOnStations, ExecutionResult};
pub use line_reader::{ANSWER_MAX_BYTES, LINE_MAX_BYTES, Line, LineError, LineReader};
pub use reply::Reply;
pub use telemetry::{TelemetryLine, telemetry_line};

#[cfg(test)]
mod tests;

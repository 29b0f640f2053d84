#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod command_handler;
mod error;
mod finger_address;
mod line_checksum;
mod line_reader;
mod pulse;
mod reply;
mod station_command;
mod telemetry;
mod upload;

pub use command_handler::{CommandHandler, ExecuteOnStations, ExecutionResult};
pub use error::{Error, StorageFailureText};
pub use line_checksum::{ChecksumError, OutgoingLine, line_checksum, strip_checksum, write_line};
pub use line_reader::{ANSWER_MAX_BYTES, LINE_MAX_BYTES, Line, LineError, LineReader};
pub use reply::Reply;
pub use station_command::check_line;
pub use telemetry::UnsolicitedLine;
pub use thermal_wire::answer::{BoardStatus, PersonCodes, PersonReply};
pub use upload::UploadError;

#[cfg(test)]
mod tests;

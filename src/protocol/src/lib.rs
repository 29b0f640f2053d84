#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod arguments;
mod board_status;
mod calibrate_settings_set_commands;
mod command_handler;
mod decimal_number;
mod error;
mod events;
mod finger_address;
mod line_buffer;
mod line_checksum;
mod line_reader;
mod object;
mod person;
mod reply;
mod request;
mod stimulus;
mod telemetry;
mod upload;

pub use board_status::BoardStatus;
pub use command_handler::{CommandHandler, ExecuteOnStations, ExecutionResult};
pub use error::{Error, QuotedWordExcerpt, StorageFailureText};
pub use line_checksum::{ChecksumError, OutgoingLine, line_checksum, strip_checksum, write_line};
pub use line_reader::{ANSWER_MAX_BYTES, LINE_MAX_BYTES, Line, LineError, LineReader};
pub use person::{PersonCodes, PersonReply, PersonRequest};
pub use reply::{Reply, TUNED_WORD, UNTUNED_WORD};
pub use request::{CONTACT_MODEL_WORDS, CUSTOM_MATERIAL_WORD, NOMINAL_CONTACT_LAW_WORD, Request};
pub use telemetry::{TelemetryLine, UnsolicitedLine};
pub use upload::UploadError;

#[cfg(test)]
mod tests;

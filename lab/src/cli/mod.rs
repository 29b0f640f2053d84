//! The subcommands, and what they have in common.

pub mod analyse;
pub mod bring_up;
pub mod commission;
pub mod contact;
pub mod enrol;
pub mod info;
mod kept_files;
pub mod log;
pub mod monitor;
pub mod participants;
pub mod play;
pub mod ports;
pub mod predict;
pub mod replay;
pub mod run;
pub mod send;
mod target;
mod window;

use std::io::{Write, stdout};

use anyhow::Context;
use thermal_client::text::escaped_text;

use kept_files::KeptFiles;
pub use target::Target;
pub use thermal_sim::Failure;

/// Writes what somebody should know to standard error.
fn notice(text: &str) {
    eprintln!("thermal-lab: {}", escaped_text(text));
}

/// Writes a line to standard output.
fn print(text: &str) -> Result<(), Failure> {
    writeln!(stdout(), "{text}").context("standard output").map_err(Failure::run)
}

/// Writes a text that ends with a line end to standard output.
fn print_text(text: &str) -> Result<(), Failure> {
    write!(stdout(), "{text}").context("standard output").map_err(Failure::run)
}

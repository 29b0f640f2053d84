//! The subcommands, and what they have in common.

pub mod bring_up;
pub mod commission;
pub mod info;
pub mod log;
pub mod ports;
pub mod send;
mod target;

use std::io::{Write, stdout};

use anyhow::Context;

pub use target::Target;

/// Why a command failed, and the exit status that says so.
#[derive(Debug)]
pub struct Failure {
    /// What went wrong.
    pub error: anyhow::Error,
    /// 1 for a device that does not do it, 2 for bad input.
    pub status: u8,
}

impl Failure {
    /// Something that the user gave is wrong.
    pub fn input(error: impl Into<anyhow::Error>) -> Self {
        Self {
            error: error.into(),
            status: 2,
        }
    }

    /// Everything given is right, but it did not work.
    pub fn run(error: impl Into<anyhow::Error>) -> Self {
        Self {
            error: error.into(),
            status: 1,
        }
    }
}

/// Writes a line to standard output.
fn print(text: &str) -> Result<(), Failure> {
    writeln!(stdout(), "{text}")
        .context("standard output")
        .map_err(Failure::run)
}

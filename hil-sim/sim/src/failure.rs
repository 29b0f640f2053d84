//! How the commands end that run a simulated device.

use std::fmt;
use std::process::ExitCode;

use thermal_client::text::escaped_text;

/// Why a command failed, and the exit status that says so.
#[derive(Debug)]
pub struct Failure {
    /// What went wrong.
    pub error: anyhow::Error,
    /// 1 for a run that failed or a device that does not do it, 2 for bad input.
    pub status: u8,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#}", self.error)
    }
}

impl Failure {
    /// Something that the user gave is wrong.
    pub fn input(error: impl Into<anyhow::Error>) -> Self {
        Self { error: error.into(), status: 2 }
    }

    /// Everything given is right, but it did not work.
    pub fn run(error: impl Into<anyhow::Error>) -> Self {
        Self { error: error.into(), status: 1 }
    }

    /// The exit code of a command with this name that ended so. Prints why it failed, if it did, on standard error.
    pub fn exit_code(command: &str, ended: Result<(), Self>) -> ExitCode {
        match ended {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => {
                eprintln!("{command}: {}", escaped_text(&failure.to_string()));
                ExitCode::from(failure.status)
            }
        }
    }
}

//! The subcommands.

pub mod commission;
#[cfg(feature = "emulator")]
pub mod embedded_tests;
mod engine;
pub mod erfcx;
pub mod faults;
pub mod fidelity;
pub mod five_fingers;
#[cfg(feature = "emulator")]
mod image;
pub mod infrared;
pub mod model;
pub mod object;
mod output;
pub mod parameters;
#[cfg(feature = "emulator")]
pub mod profile;
pub mod roughness;
pub mod run;
pub mod serve;
pub mod thesis;

/// Why a command failed, and the exit status that says so.
#[derive(Debug)]
pub struct Failure {
    /// What went wrong.
    pub error: anyhow::Error,
    /// 1 for a failed run, 2 for bad input.
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

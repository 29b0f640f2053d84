//! The subcommands.

pub mod commission;
pub mod display;
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
pub mod play;
#[cfg(feature = "emulator")]
pub mod profile;
pub mod roughness;
pub mod run;
pub mod serve;
pub mod thesis;
pub mod tracking;

pub use thermal_sim::Failure;

#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod decay;
mod estimate;
mod learner;
mod output;
mod parameters;
mod person;
mod recent;
mod regressors;
mod sensor;
mod signals;
mod trust;
mod window;

pub use learner::Learner;
pub use output::LearnerOutput;
pub use parameters::{PARAMETERS, PlaceBeforeContact};
pub use person::PersonPrior;
pub use sensor::FluxSensor;
pub use trust::{Distrust, Trust};
pub use window::{ContactInput, Flux, LearnerInput, Resistance, Restart, WINDOW_TICKS};

#[cfg(test)]
mod tests;

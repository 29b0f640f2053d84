#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod fingers;
mod fit;
mod layers;
mod nonnegative;

pub use fit::{Fit, RATE_MAX_1_S, fit};
pub use layers::{Back, Layer, impedance};

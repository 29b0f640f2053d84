#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod fit;
mod ramps;
mod recording;
mod thermal_signals;

pub use fit::{Fit, Interval, fit};
pub use ramps::{FORCES_N, LEGS, RAMPS_S, force_n, leg_at};
pub use recording::{Recording, RecordingError, Sample};

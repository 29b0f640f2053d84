#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod fit;
mod following;
mod measurement;
mod ramps;
mod recording;
mod thermal_signals;

pub use fit::{Fit, Interval, fit};
pub use following::{Following, FollowingError};
pub use measurement::{HELD_C, Measurement, MeasurementError, Order, Step, measure};
pub use ramps::{FORCES_N, LEGS, RAMPS_S, force_n, leg_at};
pub use recording::{Recording, RecordingError, Sample};

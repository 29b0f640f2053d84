#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod fit;
mod force_tracking;
mod measurement;
mod ramps;
mod recording;
mod thermal_signals;

pub use fit::{Fit, Interval, fit};
pub use force_tracking::{ForceTracking, ForceTrackingError};
pub use measurement::{HELD_C, Measurement, MeasurementError, MeasurementOptions, Step, measure};
pub use ramps::{FORCES_N, RAMPS, TOTAL_S, force_n, ramp_at};
pub use recording::{Recording, RecordingError, Sample};

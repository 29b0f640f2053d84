#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod calibration_fit;
mod calibration_points;
mod cholesky;
mod identification;
mod request;
mod session;
mod stability_margins;
mod storage;

pub use calibration_points::{POINTS_PER_THERMISTOR_MAX, PointError, REFERENCE_DIFFERENCE_MAX_K};
pub use identification::IdentificationError;
pub use request::{
    CONVERTER_STEPS_PER_LINE, SENSOR_WORDS, SessionError, SessionReply, SessionRequest, Setting,
};
pub use session::{CommissioningSession, ExecuteOnStation, SETTINGS_LINES};
pub use stability_margins::StabilityMargins;
pub use storage::StorageOrder;

#[cfg(test)]
mod tests;

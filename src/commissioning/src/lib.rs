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

pub use calibration_points::{POINT_DEVIATION_MAX_K, POINTS_MAX, PointError};
pub use identification::IdentificationError;
pub use request::{
    SENSOR_WORDS, STEPS_PER_LINE, SessionError, SessionReply, SessionRequest, Setting,
};
pub use session::{CommissioningSession, ExecuteOnStation, SETTINGS_LINES};
pub use stability_margins::StabilityMargins;
pub use storage::StorageOrder;

#[cfg(test)]
mod tests;

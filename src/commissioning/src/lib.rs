#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod calibration_fit;
mod calibration_points;
mod cholesky;
mod session;
mod session_messages;
mod stability_margins;
mod storage_order;
mod tile_identification;

pub use calibration_points::{POINTS_PER_THERMISTOR_MAX, PointError, REFERENCE_DIFFERENCE_MAX_K};
pub use cholesky::solve_by_cholesky;
pub use session::{CommissioningSession, ExecuteOnStation};
pub use session_messages::{SessionError, SessionReply};
pub use stability_margins::StabilityMargins;
pub use storage_order::StorageOrder;
pub use tile_identification::IdentificationError;

#[cfg(test)]
mod tests;

//! Commissioning: the device calibrates its thermistors against a reference thermometer, and finds out about its tile.
//!
//! What needs `f64` is done here, by the task that answers the host, while the tick goes on; the station only averages
//! and adds up.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod fit;
mod identify;
mod margins;
mod points;
mod request;
mod session;
mod solve;
mod storage;

pub use identify::NoTile;
pub use margins::Margins;
pub use points::{FARTHEST_K, POINTS, Point, PointError};
pub use request::{Error, Reply, Request, SENSORS, STEPS_A_LINE, Setting};
pub use session::{SETTINGS_LINES, Service};
pub use storage::{StorageOrder, is_off, record};

#[cfg(test)]
mod tests;

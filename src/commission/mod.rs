//! Commissioning: the device calibrates its thermistors against a reference thermometer, and finds out about its tile.
//!
//! What needs `f64` is done here, by the task that answers the host, while the tick goes on; the station only averages
//! and adds up.

mod desk;
mod experiment;
mod fit;
mod identify;
mod keep;
mod margins;
mod points;
mod request;
mod service;
mod solve;
mod sums;

pub use desk::Desk;
pub use experiment::{Aborted, Experiment, Row};
pub use identify::NoTile;
pub use keep::Order;
pub use margins::Margins;
pub use points::{FARTHEST_K, POINTS, Point, PointError, Points};
pub use request::{SENSORS, STEPS_A_LINE};
pub(crate) use request::{calibration_beyond, tile_beyond};

#[cfg(test)]
mod tests;

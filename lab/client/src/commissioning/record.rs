//! The record of a commissioning.

use serde::Serialize;

use crate::client::IdentifiedTile;

/// A calibration point that the device accepted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibrationPoint {
    /// Name of the thermistor.
    pub sensor: &'static str,
    /// Reading of the reference thermometer, deg C.
    pub reference_c: f64,
    /// Number of points of this thermistor so far.
    pub points: u32,
    /// Largest difference between device and reference at these points, mK.
    pub worst_mk: f64,
}

/// Result of commissioning a device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CommissioningRecord {
    /// The calibration points in their order.
    pub points: Vec<CalibrationPoint>,
    /// The identified tile.
    pub tile: IdentifiedTile,
    /// The settings as lines; sent to the device, they restore it.
    pub settings: Vec<String>,
}

/// An event during commissioning.
#[derive(Clone, Debug, PartialEq)]
pub enum CommissioningEvent {
    /// A step begins.
    StepStarted(&'static str),
    /// The display moves to this temperature, deg C.
    HoldStarted(f64),
    /// The device accepted a calibration point.
    PointAccepted(CalibrationPoint),
    /// The device refused a calibration point.
    PointRefused {
        /// Name of the thermistor.
        sensor: &'static str,
        /// The device's reason.
        why: String,
    },
    /// The device identified its tile.
    TileIdentified(IdentifiedTile),
}

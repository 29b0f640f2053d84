//! The record of a commissioning, and what happens in it.

use std::fmt;

use serde::Serialize;

use super::FluxCalibration;
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
    /// Calibration of the heat-flux sensor, if the device has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flux: Option<FluxCalibration>,
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
    /// The heat-flux sensor is calibrated.
    FluxCalibrated(FluxCalibration),
}

impl fmt::Display for CommissioningEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepStarted(what) => f.write_str(what),
            Self::HoldStarted(hold_c) => write!(f, "  the display goes to {hold_c:.2} C"),
            Self::PointAccepted(point) => write!(
                f,
                "  {:8} {:7.3} C   point {:2}, fits to {:.2} mK",
                point.sensor, point.reference_c, point.points, point.worst_mk
            ),
            Self::PointRefused { sensor, why } => write!(f, "  {sensor:8} not taken: {why}"),
            Self::TileIdentified(tile) => write!(f, "  {tile}"),
            Self::FluxCalibrated(calibration) => write!(f, "  {calibration}"),
        }
    }
}

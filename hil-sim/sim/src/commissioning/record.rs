//! The operator's record.

use std::str::FromStr;

use serde::Serialize;

use super::CommissionError;

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

/// The tile as identified by the device, and the stability margins of its control loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IdentifiedTile {
    /// Rate of change of the plate temperature per demanded current, K/s per A.
    pub gain_k_s_a: f64,
    /// Relative loss of this gain by Joule heat per current, 1/A.
    pub joule_per_a: f64,
    /// Rate at which the plate relaxes, 1/s.
    pub leak_1_s: f64,
    /// Lag of the display's thermistor, s.
    pub lag_s: f64,
    /// Dead time from the demanded current to the surface of the plate, s.
    pub dead_s: f64,
    /// Phase margin, degrees.
    pub phase_deg: f64,
    /// Gain margin, as a factor.
    pub gain_margin: f64,
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
    /// The operator starts a step.
    StepStarted(&'static str),
    /// The device accepted a calibration point.
    PointAccepted(CalibrationPoint),
    /// The device refused a calibration point.
    PointRefused {
        /// Name of the thermistor.
        sensor: &'static str,
        /// The device's answer.
        answer: String,
    },
    /// The device identified its tile.
    TileIdentified(IdentifiedTile),
}

/// The number behind `name=` in an answer; the first one if the name occurs twice.
fn number<T: FromStr>(line: &str, answer: &str, name: &str) -> Result<T, CommissionError> {
    let mut words = answer.split(' ').filter_map(|word| word.split_once('='));
    let value = words.find_map(|(word, number)| (word == name).then(|| number.parse().ok())?);
    value.ok_or_else(|| CommissionError::Refused {
        line: line.into(),
        answer: answer.into(),
    })
}

impl IdentifiedTile {
    /// Parses the device's answer to `tune result` or `margins`.
    ///
    /// # Errors
    /// A number is missing from the answer.
    pub fn parse(line: &str, answer: &str) -> Result<Self, CommissionError> {
        let number = |name| number(line, answer, name);
        Ok(Self {
            gain_k_s_a: number("gain")?,
            joule_per_a: number("joule")?,
            leak_1_s: number("leak")?,
            lag_s: number("lag_s")?,
            dead_s: number("dead_s")?,
            phase_deg: number("phase_deg")?,
            gain_margin: number("margin")?,
        })
    }
}

impl CalibrationPoint {
    /// Parses the device's answer to a calibration point.
    ///
    /// # Errors
    /// A number is missing from the answer.
    pub fn parse(
        sensor: &'static str,
        reference_c: f64,
        line: &str,
        answer: &str,
    ) -> Result<Self, CommissionError> {
        Ok(Self {
            sensor,
            reference_c,
            points: number(line, answer, "points")?,
            worst_mk: number(line, answer, "worst_mk")?,
        })
    }
}

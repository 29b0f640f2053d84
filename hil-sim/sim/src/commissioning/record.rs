//! What the operator writes down.

use std::str::FromStr;

use serde::Serialize;

use super::CommissionError;

/// A point that the device took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibrationPoint {
    /// Which thermistor.
    pub sensor: &'static str,
    /// What the reference thermometer showed, deg C.
    pub reference_c: f64,
    /// Points of this thermistor so far.
    pub points: u32,
    /// Largest difference of the device from the reference in them, mK.
    pub worst_mk: f64,
}

/// The tile that the device found, and the margins of its loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IdentifiedTile {
    /// Slope of the plate's temperature per current asked for, K/s per A.
    pub gain_k_s_a: f64,
    /// Loss of that per current, 1/A.
    pub joule_per_a: f64,
    /// Rate at which the plate relaxes, 1/s.
    pub leak_1_s: f64,
    /// Lag of the display's thermistor, s.
    pub lag_s: f64,
    /// From a current that is asked for to the plate's surface, s.
    pub dead_s: f64,
    /// Phase that is left where the loop's gain is one, degrees.
    pub phase_deg: f64,
    /// Factor by which the loop's gain could grow.
    pub gain_margin: f64,
}

/// What the operator goes home with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CommissioningRecord {
    /// The points, in the order in which they were taken.
    pub points: Vec<CalibrationPoint>,
    /// What was found of the tile.
    pub tile: IdentifiedTile,
    /// The settings as lines; sent to the device, they restore it.
    pub settings: Vec<String>,
}

/// What happens at the bench.
#[derive(Clone, Debug, PartialEq)]
pub enum CommissioningEvent {
    /// The operator begins with something.
    StepStarted(&'static str),
    /// The device took a point.
    PointAccepted(CalibrationPoint),
    /// The device did not take a point yet, or will not, and says why.
    PointRefused {
        /// Which thermistor.
        sensor: &'static str,
        /// The device's answer.
        answer: String,
    },
    /// The device found its tile.
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

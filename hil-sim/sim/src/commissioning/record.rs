//! What the operator writes down.

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

/// Numbers behind the names of an answer, in the order of the names; what is there twice counts once.
fn numbers<const N: usize>(
    line: &str,
    answer: &str,
    names: [&str; N],
) -> Result<[f64; N], CommissionError> {
    let mut values = [0.0; N];
    for (value, name) in values.iter_mut().zip(names) {
        let found = answer
            .split(' ')
            .filter_map(|word| word.split_once('='))
            .find_map(|(word, number)| (word == name).then(|| number.parse().ok())?);
        *value = found.ok_or_else(|| CommissionError::Refused {
            line: line.into(),
            answer: answer.into(),
        })?;
    }
    Ok(values)
}

impl IdentifiedTile {
    /// From what the device answers to `tune result` or `margins`.
    ///
    /// # Errors
    /// It is no such answer.
    pub fn parse(line: &str, answer: &str) -> Result<Self, CommissionError> {
        let names = [
            "gain",
            "joule",
            "leak",
            "lag_s",
            "dead_s",
            "phase_deg",
            "margin",
        ];
        let [
            gain_k_s_a,
            joule_per_a,
            leak_1_s,
            lag_s,
            dead_s,
            phase_deg,
            gain_margin,
        ] = numbers(line, answer, names)?;
        Ok(Self {
            gain_k_s_a,
            joule_per_a,
            leak_1_s,
            lag_s,
            dead_s,
            phase_deg,
            gain_margin,
        })
    }
}

impl CalibrationPoint {
    /// From what the device answers to a point.
    ///
    /// # Errors
    /// It is no such answer.
    pub fn parse(
        sensor: &'static str,
        reference_c: f64,
        line: &str,
        answer: &str,
    ) -> Result<Self, CommissionError> {
        let [points, worst_mk] = numbers(line, answer, ["points", "worst_mk"])?;
        Ok(Self {
            sensor,
            reference_c,
            points: points as u32,
            worst_mk,
        })
    }
}

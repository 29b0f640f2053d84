//! What a host may ask of a commissioning session, and what is answered.

use thermal_device::command::Refused;
use thermal_device::sense::THERMISTORS;
use thermal_settings::{Correction, Tile};

use crate::{Margins, NoTile, PointError};

/// The thermistors' words.
pub const SENSORS: [&str; THERMISTORS] = ["display", "check", "sink", "skin", "room"];
/// Steps on one line.
pub const STEPS_A_LINE: usize = 7;

/// What a line of commissioning asks of one finger.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// `calibrate SENSOR CELSIUS`: what the reference thermometer says.
    Point {
        /// Which thermistor.
        sensor: usize,
        /// The reference thermometer, °C.
        reference_c: f64,
    },
    /// `calibrate SENSOR clear`: back to the class values.
    Clear {
        /// Which thermistor.
        sensor: usize,
    },
    /// `settings`: how many lines; `settings N`: one of them.
    Settings(Option<usize>),
    /// `set steps BORDER COUNTS...`: up to seven of the converter's steps.
    SetSteps {
        /// The first border.
        first: usize,
        /// Steps from there on, counts.
        counts: heapless::Vec<f64, STEPS_A_LINE>,
    },
    /// `set correction SENSOR OFFSET SLOPE CURVATURE`.
    SetCorrection {
        /// Which thermistor.
        sensor: usize,
        /// Its correction.
        correction: Correction,
    },
    /// `set tile GAIN JOULE LEAK LAG DEAD`.
    SetTile(Tile),
    /// `tune result`.
    Tuned,
    /// `margins`.
    Margins,
}

/// What a commissioning session answers.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// The request was executed.
    Done,
    /// Answer to [`Request::Tuned`] and [`Request::Margins`].
    Tile(Tile, Margins),
    /// Answer to [`Request::Point`].
    Calibrated {
        /// Points of this thermistor.
        points: usize,
        /// Largest difference of the device from the reference in them, mK.
        worst_mk: f64,
    },
    /// How many lines hold all commissioned settings.
    SettingsLines(usize),
    /// One of these lines.
    Setting(Setting),
}

/// A part of the settings.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Some of the converter's steps.
    Steps {
        /// The first border.
        first: usize,
        /// Steps from there on, counts.
        counts: heapless::Vec<f64, STEPS_A_LINE>,
    },
    /// A thermistor's correction.
    Correction(&'static str, Correction),
    /// The tile.
    Tile(Tile),
}

/// Why a commissioning session refuses a request; nothing has changed then.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The station refuses.
    Refused(Refused),
    /// The identification's sums belong to no tile within the limits of settings.
    NoTile(NoTile),
    /// A point of a calibration is not taken.
    Point(PointError),
}

impl From<Refused> for Error {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

//! Requests to a commissioning session, its replies and its errors.

use thermal_device::command::Refused;
use thermal_device::sense::THERMISTORS;
use thermal_settings::{Correction, Tile};

use crate::{IdentificationError, PointError, StabilityMargins};

/// Words for the thermistors on a line of text, in the order of their indices.
pub const SENSOR_WORDS: [&str; THERMISTORS] = ["display", "check", "sink", "skin", "room"];
/// Largest number of converter steps on one line.
pub const STEPS_PER_LINE: usize = 7;

/// A request to the commissioning session of one finger, read from a line of text.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionRequest {
    /// `calibrate SENSOR CELSIUS`: adds a calibration point.
    AddPoint {
        /// Index of the thermistor.
        sensor: usize,
        /// Temperature of the reference thermometer, °C.
        reference_c: f64,
    },
    /// `calibrate SENSOR clear`: removes a thermistor's points and its correction.
    ClearCalibration {
        /// Index of the thermistor.
        sensor: usize,
    },
    /// `settings`: reports the number of lines that [`Self::SettingsLine`] has.
    CountSettingsLines,
    /// `settings N`: reports one line of the settings, by its index from 0.
    SettingsLine(usize),
    /// `tune result`: identifies the tile from the recorded response, and uses it.
    TuneResult,
    /// `margins`: reports the tile and the stability margins of its loop.
    Margins,
    /// `set ...`: replaces a part of the settings.
    Set(Setting),
}

/// The reply of a commissioning session.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionReply {
    /// The request was executed.
    Done,
    /// Reply to [`SessionRequest::TuneResult`] and [`SessionRequest::Margins`].
    Tile(Tile, StabilityMargins),
    /// Reply to [`SessionRequest::AddPoint`].
    PointAdded {
        /// Number of points of this thermistor.
        points: usize,
        /// Largest difference between the new calibration and the reference over these points, mK.
        worst_mk: f64,
    },
    /// Reply to [`SessionRequest::CountSettingsLines`].
    SettingsLines(usize),
    /// Reply to [`SessionRequest::SettingsLine`].
    Setting(Setting),
}

/// The part of the settings that one `set` line holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// `steps BORDER COUNTS...`: up to seven steps of the converter.
    Steps {
        /// The first border, at least [`FIRST_BORDER`](thermal_settings::FIRST_BORDER).
        first: usize,
        /// Steps at this border and the next ones, counts.
        counts: heapless::Vec<f64, STEPS_PER_LINE>,
    },
    /// `correction SENSOR OFFSET SLOPE CURVATURE`: the correction of a thermistor, by its index.
    Correction(usize, Correction),
    /// `tile GAIN JOULE LEAK LAG DEAD`: the parameters of the tile.
    Tile(Tile),
}

/// Why a commissioning session rejects a request; the settings are unchanged then.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionError {
    /// The station refuses a command that the request needs.
    Refused(Refused),
    /// The recorded response is not that of a tile.
    Identification(IdentificationError),
    /// The calibration point is rejected.
    Point(PointError),
}

impl From<Refused> for SessionError {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

//! Requests to a commissioning session, its replies and its errors.

use contact_model::fixed_point::ContactPairError;
use thermal_device::command::{FluxState, Refused};
use thermal_device::sense::THERMISTOR_COUNT;
use thermal_settings::{Correction, DisplaySurface, FluxSensor, Tile};

use crate::{IdentificationError, PointError, StabilityMargins};

/// Words for the five thermistors in lines from and to the host, in the order of their indices. `check` is the
/// display's second thermistor.
pub const THERMISTOR_WORDS: [&str; THERMISTOR_COUNT] = ["display", "check", "sink", "skin", "room"];
/// Largest number of converter steps on one line of the settings. The converter has a calibrated step at each of 13
/// borders of its segments, so the steps take two lines.
pub const CONVERTER_STEPS_PER_LINE_MAX: usize = 7;

/// A request of the host to the commissioning session of one finger. Each variant begins with the line of text from
/// which `thermal-protocol` reads it.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionRequest {
    /// `calibrate SENSOR CELSIUS`: adds a calibration point, that is the mean of the thermistor's converter sums over
    /// half a second and the temperature of the reference thermometer. The calibration that fits all points is used
    /// from then on.
    AddPoint {
        /// Index of the thermistor to calibrate, 0 to 4, in the order of [`THERMISTOR_WORDS`].
        sensor: usize,
        /// Temperature that the reference thermometer shows at the thermistor, °C.
        reference_c: f64,
    },
    /// `calibrate SENSOR clear`: removes a thermistor's calibration points, and sets its correction to zero. If the
    /// corrections of both display thermistors are zero then, the converter's steps are set to zero, too.
    ClearCalibration {
        /// Index of the thermistor whose calibration is removed, 0 to 4, in the order of [`THERMISTOR_WORDS`].
        sensor: usize,
    },
    /// `settings`: reports the number of lines that hold the settings, which [`Self::SettingsLine`] reports one by one.
    CountSettingsLines,
    /// `settings N`: reports one line of the settings. The value is `N - 1`, the index of the line from 0.
    SettingsLine(usize),
    /// `tune result`: computes the tile's parameters from the response that the station has recorded during a complete
    /// `tune`, and uses them in place of the present ones; `save` stores them. Reports them with the stability margins.
    TuneResult,
    /// `margins`: reports the present parameters of the tile, and with them the phase margin and the gain margin of the
    /// temperature loop that the law `pi` closes.
    Margins,
    /// `flux`: reports the heat-flux sensor, its flux, and what is known of the finger by it.
    Flux,
    /// `flux zero`: takes the mean of the sensor's code over the last half second as its zero.
    FluxZero,
    /// `surface`: reports the surface of the display.
    DisplaySurface,
    /// `set ...`, `flux set ...`, `flux none`, `surface set ...` and `surface nominal`: replaces the part of the settings that the line holds, and uses it from the next tick on. A line with
    /// a correction also removes the calibration points of its thermistor; a line with steps removes those of both
    /// display thermistors.
    Set(Setting),
}

/// What a commissioning session replies to a request that it has executed; [`SessionError`] is the reply to the others.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionReply {
    /// The request was executed, and there is nothing to report: reply to [`SessionRequest::ClearCalibration`],
    /// [`SessionRequest::FluxZero`] and [`SessionRequest::Set`].
    Done,
    /// The present parameters of the tile, and with them the stability margins of the temperature loop that the law
    /// `pi` closes: reply to [`SessionRequest::TuneResult`] and [`SessionRequest::Margins`].
    Tile(Tile, StabilityMargins),
    /// The calibration point was added, and the calibration fitted again is in use: reply to
    /// [`SessionRequest::AddPoint`].
    PointAdded {
        /// Number of calibration points that this thermistor has now, the new one included.
        points: usize,
        /// Largest difference in magnitude, mK, between this thermistor's reading with the new calibration and the
        /// reference thermometer, over all its calibration points.
        worst_mk: f64,
    },
    /// The heat-flux sensor with what its station knows by it; `None` if it is not fitted: reply to [`SessionRequest::Flux`].
    Flux(Option<(FluxSensor, FluxState)>),
    /// The surface of the display: reply to [`SessionRequest::DisplaySurface`].
    DisplaySurface(DisplaySurface),
    /// Number of lines that hold the settings: reply to [`SessionRequest::CountSettingsLines`].
    SettingsLines(usize),
    /// One line of the settings: reply to [`SessionRequest::SettingsLine`].
    Setting(Setting),
}

/// The part of a finger's settings that one line holds: a line that the host sends after `set`, or that the device
/// replies to `settings N`.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// `steps BORDER COUNTS...`: one to seven steps of the converter's error at successive borders of its segments,
    /// from the border `first` on. A step is the error just above a border minus that just below, converter counts.
    Steps {
        /// Index of the border to which the first element of `counts` belongs, 10 to 22; border `n` lies at the
        /// converter's code `128 n`.
        first: usize,
        /// Steps at the border `first` and at the borders after it, converter counts; positive if the code above the
        /// border is too high.
        counts: heapless::Vec<f64, CONVERTER_STEPS_PER_LINE_MAX>,
    },
    /// `correction SENSOR OFFSET SLOPE CURVATURE`: index of a thermistor (0 to 4, in the order of [`THERMISTOR_WORDS`]),
    /// and the correction that is added to its temperature, with offset (K), slope (K/K) and curvature (1/K).
    Correction(usize, Correction),
    /// `tile GAIN JOULE LEAK LAG DEAD`: the tile's gain (cooling rate per ampere, K/s per A), Joule term (Joule heating
    /// relative to the cooling, 1/A), leak (rate at which a temperature deviation decays, 1/s), lag of the display's
    /// thermistor (s) and dead time (s).
    Tile(Tile),
    /// `flux GAIN ZERO LAG RESISTANCE`: the heat-flux sensor's gain (counts per W/m²), zero (counts), lag (ms) and thermal
    /// resistance (mm² K/W); `flux none` without one.
    FluxSensor(Option<FluxSensor>),
    /// `surface CONDUCTIVITY ROUGHNESS SLOPE`: the display's conductivity (W/mK), roughness (µm) and slope (rad); `surface nominal`
    /// for those of the reference design.
    DisplaySurface(DisplaySurface),
}

/// Why a commissioning session rejects a request. The settings are unchanged then.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionError {
    /// The finger's station refuses a command that the request needs; the value says why it refuses.
    Refused(Refused),
    /// No tile can be computed from the response that the station has recorded during `tune`; the value is the reason.
    Identification(IdentificationError),
    /// The calibration point is rejected; the value is the reason.
    Point(PointError),
    /// The contact model cannot represent the chosen material on this surface of the display; the value is the reason.
    ContactPair(ContactPairError),
}

impl From<Refused> for SessionError {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

//! The commissioning session of one finger: its settings, and the requests that change them.

use core::ops::Range;

use super::calibration_fit::{DISPLAY_SENSORS, fit, reading_c};
use super::calibration_points::{PointError, Points};
use super::identification::identify;
use super::request::{
    SENSOR_WORDS, STEPS_PER_LINE, SessionError, SessionReply, SessionRequest, Setting,
};
use super::stability_margins::StabilityMargins;
use thermal_device::command::{self, Command, Refused};
use thermal_device::control::ControlParameters;
use thermal_device::identification::{NormalEquationRow, ROWS};
use thermal_device::sense::CalibrationTables;
use thermal_settings::{BORDER_COUNT, Calibration, Correction, FIRST_BORDER, Settings, Tile};

/// Number of lines that hold the steps.
const STEPS_LINES: usize = BORDER_COUNT.div_ceil(STEPS_PER_LINE);
/// Number of lines that hold all commissioned settings: the steps, one correction for each thermistor, the tile.
pub const SETTINGS_LINES: usize = STEPS_LINES + SENSOR_WORDS.len() + 1;

/// Executes a command on the session's station in bounded and short time.
pub trait ExecuteOnStation: FnMut(Command) -> Result<command::Reply, Refused> {}

impl<F: FnMut(Command) -> Result<command::Reply, Refused>> ExecuteOnStation for F {}

/// The settings of one finger, and its calibration points.
#[derive(Clone, Debug)]
pub struct CommissioningSession {
    settings: Settings,
    points: Points,
    /// Prior of the calibration fit: the calibration before the first point, or what the host has set since.
    prior: Calibration,
}

impl CommissioningSession {
    /// A session of a finger with these settings, without calibration points.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            points: Points::default(),
            prior: settings.calibration,
        }
    }

    /// The present settings.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Executes a request. Time-consuming computations are done here, outside of `execute`, which runs with the control
    /// tick locked out.
    ///
    /// # Errors
    /// The request is rejected, and the settings are unchanged.
    pub fn answer(
        &mut self,
        request: SessionRequest,
        mut execute: impl ExecuteOnStation,
    ) -> Result<SessionReply, SessionError> {
        match request {
            SessionRequest::AddPoint {
                sensor,
                reference_c,
            } => return self.add_point(sensor, reference_c, &mut execute),
            SessionRequest::ClearCalibration { sensor } => {
                self.clear_calibration(sensor, &mut execute)?;
            }
            SessionRequest::Set(Setting::Steps { first, counts }) => {
                let mut calibration = self.settings.calibration;
                let steps = calibration.steps_counts.iter_mut();
                for (step, count) in steps.skip(first - FIRST_BORDER).zip(&counts) {
                    *step = *count;
                }
                self.set_calibration(calibration, calibration, 0..DISPLAY_SENSORS, &mut execute)?;
            }
            SessionRequest::Set(Setting::Correction(sensor, correction)) => {
                let (calibration, prior) = self.with_correction(sensor, correction);
                self.set_calibration(calibration, prior, sensor..sensor + 1, &mut execute)?;
            }
            SessionRequest::Set(Setting::Tile(tile)) => self.set_tile(tile, &mut execute)?,
            SessionRequest::TuneResult => {
                self.identify_tile(&mut execute)?;
                return Ok(self.tile());
            }
            SessionRequest::Margins => return Ok(self.tile()),
            SessionRequest::CountSettingsLines => {
                return Ok(SessionReply::SettingsLines(SETTINGS_LINES));
            }
            SessionRequest::SettingsLine(index) => {
                return Ok(SessionReply::Setting(self.setting(index)));
            }
        }
        Ok(SessionReply::Done)
    }

    /// Identifies the tile from the response that the station recorded, and uses it.
    fn identify_tile(&mut self, execute: &mut impl ExecuteOnStation) -> Result<(), SessionError> {
        let mut rows = [NormalEquationRow::default(); ROWS];
        for (i, row) in rows.iter_mut().enumerate() {
            let command::Reply::NormalEquation(sums) = execute(Command::NormalEquation(i))? else {
                return Err(Refused::NotTuned.into());
            };
            *row = sums;
        }
        let tile = identify(&rows).map_err(SessionError::Identification)?;
        Ok(self.set_tile(tile, execute)?)
    }

    /// Replaces the tile's parameters if the station accepts them.
    fn set_tile(&mut self, tile: Tile, execute: &mut impl ExecuteOnStation) -> Result<(), Refused> {
        let mut settings = self.settings;
        settings.set_tile(tile);
        execute(Command::Retune(ControlParameters::new(&settings)))?;
        self.settings = settings;
        Ok(())
    }

    fn tile(&self) -> SessionReply {
        let Settings { tile, gains, .. } = &self.settings;
        SessionReply::Tile(*tile, StabilityMargins::new(tile, gains))
    }

    /// Replaces the calibration if the station accepts it. Not inlined: the copy of the settings takes stack only here.
    #[inline(never)]
    fn apply(
        &mut self,
        calibration: Calibration,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        let settings = Settings {
            calibration,
            ..self.settings
        };
        execute(Command::Calibrate(CalibrationTables::new(&settings)))?;
        self.settings = settings;
        Ok(())
    }

    /// Replaces the calibration and the prior if the station accepts them, and removes the points of the sensors that the
    /// prior now describes.
    fn set_calibration(
        &mut self,
        calibration: Calibration,
        prior: Calibration,
        sensors: Range<usize>,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        self.apply(calibration, execute)?;
        self.prior = prior;
        sensors.for_each(|sensor| self.points.clear(sensor));
        Ok(())
    }

    /// The present calibration and prior with another correction of one thermistor.
    fn with_correction(&self, sensor: usize, correction: Correction) -> (Calibration, Calibration) {
        let replaced = |mut calibration: Calibration| {
            if let Some(place) = calibration.corrections.get_mut(sensor) {
                *place = correction;
            }
            calibration
        };
        (replaced(self.settings.calibration), replaced(self.prior))
    }

    /// Removes a thermistor's points and correction. The steps of the converter are removed with the correction of the
    /// last thermistor that determines them.
    fn clear_calibration(
        &mut self,
        sensor: usize,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        let (mut calibration, mut prior) = self.with_correction(sensor, Correction::default());
        let mut display = calibration.corrections.iter().take(DISPLAY_SENSORS);
        if display.all(|correction| *correction == Correction::default()) {
            calibration.steps_counts = [0.0; BORDER_COUNT];
            prior.steps_counts = [0.0; BORDER_COUNT];
        }
        self.set_calibration(calibration, prior, sensor..sensor + 1, execute)
    }

    /// Adds a calibration point at the present average of a thermistor, and uses the calibration that fits all points.
    fn add_point(
        &mut self,
        sensor: usize,
        reference_c: f64,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<SessionReply, SessionError> {
        let command::Reply::Average(average) = execute(Command::Average(sensor))? else {
            return Err(Refused::TooEarly.into());
        };
        let present_c = reading_c(&self.settings, sensor, average.mean_sum());
        self.points
            .add(sensor, &average, present_c, reference_c)
            .map_err(SessionError::Point)?;
        let applied = fit(&self.settings, &self.prior, &self.points)
            .filter(|calibration| calibration.out_of_range().is_none())
            .ok_or(SessionError::Point(PointError::Contradicts))
            .and_then(|calibration| Ok(self.apply(calibration, execute)?));
        if applied.is_err() {
            self.points.remove_latest(sensor);
        }
        applied?;
        let points = self.points.of_sensor(sensor);
        let errors_k = points.iter().map(|point| {
            libm::fabs(reading_c(&self.settings, sensor, point.sum) - point.reference_c)
        });
        Ok(SessionReply::PointAdded {
            points: points.len(),
            worst_mk: 1e3 * errors_k.fold(0.0, f64::max),
        })
    }

    /// One line of the settings, by its index from 0.
    fn setting(&self, index: usize) -> Setting {
        let calibration = &self.settings.calibration;
        if let Some(steps) = calibration.steps_counts.chunks(STEPS_PER_LINE).nth(index) {
            return Setting::Steps {
                first: FIRST_BORDER + index * STEPS_PER_LINE,
                counts: heapless::Vec::from_slice(steps).unwrap_or_default(),
            };
        }
        let sensor = index - STEPS_LINES;
        match calibration.corrections.get(sensor) {
            Some(correction) => Setting::Correction(sensor, *correction),
            None => Setting::Tile(self.settings.tile),
        }
    }
}

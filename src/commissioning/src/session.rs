//! One finger's settings, and the slow half of the commands that change them.

use super::fit::{SWEPT, fit, reading_c};
use super::identify::identify;
use super::margins::Margins;
use super::points::{PointError, Points};
use super::request::{Error, Reply, Request, SENSORS, STEPS_A_LINE, Setting};
use thermal_device::command::{self, Command, Refused};
use thermal_device::control::Tuned;
use thermal_device::identification::{ROWS, Row};
use thermal_device::sense::Calibrated;
use thermal_settings::{BORDERS, Calibration, Correction, FIRST_BORDER, Settings, Tile};

/// Lines that hold all commissioned settings: the steps, a correction each, the tile.
pub const SETTINGS_LINES: usize = BORDERS.div_ceil(STEPS_A_LINE) + SENSORS.len() + 1;

/// The device's settings, and what changes them.
#[derive(Clone, Debug)]
pub struct Service {
    settings: Settings,
    points: Points,
    /// What the points correct: class values, or what the host has set.
    before: Calibration,
}

impl Service {
    /// For a device with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            points: Points::default(),
            before: settings.calibration,
        }
    }

    /// The settings as they are now.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Obeys one finger's line of commissioning. `execute` is what its station does with a [`Command`], in bounded
    /// and short time; all that takes longer is done here, before or between.
    ///
    /// # Errors
    /// Why it is refused; nothing has changed.
    pub fn answer(
        &mut self,
        request: Request,
        mut execute: impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<Reply, Error> {
        match request {
            Request::Point {
                sensor,
                reference_c,
            } => self.point(sensor, reference_c, &mut execute),
            Request::Clear { sensor } => {
                self.may_calibrate(&mut execute)?;
                self.correct(sensor, Correction::default());
                self.clear_steps();
                self.calibrate(&mut execute)
            }
            Request::Settings(None) => Ok(Reply::SettingsLines(SETTINGS_LINES)),
            Request::Settings(Some(line)) => Ok(Reply::Setting(self.line(line - 1))),
            Request::SetSteps { first, counts } => {
                self.may_calibrate(&mut execute)?;
                let steps = &mut self.settings.calibration.steps_counts;
                for (step, count) in steps.iter_mut().skip(first - FIRST_BORDER).zip(&counts) {
                    *step = *count;
                }
                self.before = self.settings.calibration;
                (0..SWEPT).for_each(|sensor| self.points.clear(sensor));
                self.calibrate(&mut execute)
            }
            Request::SetCorrection { sensor, correction } => {
                self.may_calibrate(&mut execute)?;
                self.correct(sensor, correction);
                self.calibrate(&mut execute)
            }
            Request::SetTile(tile) => self.retune(tile, &mut execute),
            Request::Tuned => self.tuned(&mut execute),
            Request::Margins => Ok(self.tile()),
        }
    }

    fn tuned(
        &mut self,
        execute: &mut impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<Reply, Error> {
        let mut rows = [Row::default(); ROWS];
        for (i, row) in rows.iter_mut().enumerate() {
            let command::Reply::Row(sums) = execute(Command::Experiment(i))? else {
                return Err(Refused::NotTuned.into());
            };
            *row = sums;
        }
        self.retune(identify(&rows).map_err(Error::NoTile)?, execute)?;
        Ok(self.tile())
    }

    /// Kept if the station goes by it.
    fn retune(
        &mut self,
        tile: Tile,
        execute: &mut impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<Reply, Error> {
        let mut settings = self.settings;
        settings.retune(tile);
        execute(Command::Retune(Tuned::new(&settings)))?;
        self.settings = settings;
        Ok(Reply::Done)
    }

    fn tile(&self) -> Reply {
        let Settings { tile, gains, .. } = &self.settings;
        Reply::Tile(*tile, Margins::of(tile, gains))
    }

    /// A correction from elsewhere: points of before count no longer, those to come start from it.
    fn correct(&mut self, sensor: usize, correction: Correction) {
        self.points.clear(sensor);
        for calibration in [&mut self.settings.calibration, &mut self.before] {
            if let Some(place) = calibration.corrections.get_mut(sensor) {
                *place = correction;
            }
        }
    }

    /// The converter's steps go with the last of what has shown them.
    fn clear_steps(&mut self) {
        let corrections = &self.settings.calibration.corrections;
        if (corrections.iter().take(SWEPT)).all(|correction| *correction == Correction::default()) {
            self.settings.calibration.steps_counts = [0.0; BORDERS];
            self.before.steps_counts = [0.0; BORDERS];
        }
    }

    /// Refused while an object is presented, before anything changes.
    fn may_calibrate(
        &self,
        execute: &mut impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<(), Refused> {
        execute(self.calibrated()).map(|_| ())
    }

    fn calibrate(
        &self,
        execute: &mut impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<Reply, Error> {
        self.may_calibrate(execute)?;
        Ok(Reply::Done)
    }

    fn calibrated(&self) -> Command {
        Command::Calibrate(Calibrated::new(&self.settings))
    }

    fn point(
        &mut self,
        sensor: usize,
        reference_c: f64,
        execute: &mut impl FnMut(Command) -> Result<command::Reply, Refused>,
    ) -> Result<Reply, Error> {
        let command::Reply::Average(average) = execute(Command::Average(sensor))? else {
            return Err(Refused::TooEarly.into());
        };
        let reads_c = reading_c(
            &self.settings,
            &self.settings.calibration,
            sensor,
            average.sum(),
        );
        (self.points.add(sensor, &average, reads_c, reference_c)).map_err(Error::Point)?;
        let fitted = fit(&self.settings, &self.before, &self.points)
            .filter(|calibration| calibration.out_of_range().is_none());
        let Some(calibration) = fitted else {
            self.points.drop_last(sensor);
            return Err(Error::Point(PointError::Contradicts));
        };
        self.settings.calibration = calibration;
        execute(self.calibrated())?;
        let points = self.points.of(sensor);
        let errors = points.iter().map(|point| {
            let reads_c = reading_c(&self.settings, &calibration, sensor, point.sum);
            libm::fabs(reads_c - point.reference_c)
        });
        Ok(Reply::Calibrated {
            points: points.len(),
            worst_mk: 1e3 * errors.fold(0.0, f64::max),
        })
    }

    /// One line of the settings, from 0.
    fn line(&self, line: usize) -> Setting {
        let calibration = &self.settings.calibration;
        let steps_lines = BORDERS.div_ceil(STEPS_A_LINE);
        if let Some(steps) = calibration.steps_counts.chunks(STEPS_A_LINE).nth(line) {
            return Setting::Steps {
                first: FIRST_BORDER + line * STEPS_A_LINE,
                counts: heapless::Vec::from_slice(steps).unwrap_or_default(),
            };
        }
        match calibration.corrections.get(line - steps_lines) {
            Some(correction) => {
                Setting::Correction(SENSORS[(line - steps_lines) % SENSORS.len()], *correction)
            }
            None => Setting::Tile(self.settings.tile),
        }
    }
}

//! The commissioning session of one finger: its settings, and the requests that change them.

use core::ops::Range;

use super::calibration_fit::{DISPLAY_THERMISTOR_COUNT, calibrated_temperature_c, fit_calibration};
use super::calibration_points::{CalibrationPoints, PointError};
use super::session_messages::{SessionError, SessionReply};
use super::stability_margins::StabilityMargins;
use super::tile_identification::tile_from_normal_equations;
use contact_model::material::MATERIALS;
use thermal_device::command::{self, ChosenMaterial, Command, Refused};
use thermal_device::control::ControlParameters;
use thermal_device::identification::{NORMAL_EQUATION_AND_STATISTICS_ROWS, NormalEquationRow};
use thermal_device::learning::FluxParameters;
use thermal_device::safety::ThermistorId;
use thermal_device::sense::CalibrationTables;
use thermal_settings::{
    CALIBRATED_ADC_BORDER_COUNT, Calibration, Correction, DisplaySurface,
    FIRST_CALIBRATED_ADC_BORDER_INDEX, FluxSensor, Settings, Tile,
};
use thermal_wire::PointOrClear;
use thermal_wire::answer::{PointsAndWorst, SensorWithState, SettingLines, TileWithMargins};
use thermal_wire::request::SessionRequest;
use thermal_wire::setting::{
    CONVERTER_STEPS_LINES, CONVERTER_STEPS_PER_LINE_MAX, SETTING_LINES_ALWAYS, Setting,
};

/// A function that executes a command on the station of the session's finger, and returns the station's reply or
/// refusal. The control tick may be locked out while it runs, so it must end after a bounded, short time.
pub trait ExecuteOnStation: FnMut(Command<'_>) -> Result<command::Reply, Refused> {}

impl<F: FnMut(Command<'_>) -> Result<command::Reply, Refused>> ExecuteOnStation for F {}

/// The commissioning of one finger by requests of the host: holds the finger's settings, with the calibration of its
/// thermistors and the parameters of its tile, and the calibration points since start-up.
#[derive(Clone, Debug)]
pub struct CommissioningSession {
    settings: Settings,
    points: CalibrationPoints,
    /// Prior of the calibration fit: the calibration at start-up, replaced by what the host has set or cleared since. A
    /// new calibration point changes the calibration in use, but not the prior.
    prior: Calibration,
}

impl CommissioningSession {
    /// A session for a finger whose station starts with these settings; it has no calibration points yet.
    pub fn new(settings: Settings) -> Self {
        Self { settings, points: CalibrationPoints::default(), prior: settings.calibration }
    }

    /// The present settings of the finger, which its station uses: those at start-up, with every accepted change since.
    /// `save` stores them.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Executes one request of the host and returns the reply to it. `execute` executes single commands on the finger's
    /// station, with the control tick locked out; so all time-consuming computations are done here, outside of
    /// `execute`.
    ///
    /// # Errors
    /// The settings are unchanged then.
    ///
    /// - [`SessionError::Refused`]: the station refuses a command that the request needs.
    /// - [`SessionError::Identification`]: `tune result`, but the recorded response gives no tile.
    /// - [`SessionError::Point`]: the calibration point is rejected.
    /// - [`SessionError::ContactPair`]: the surface of the display does not suit the contact model with the chosen material.
    pub fn answer(
        &mut self,
        request: SessionRequest,
        mut execute: impl ExecuteOnStation,
    ) -> Result<SessionReply, SessionError> {
        match request {
            SessionRequest::Calibrate { thermistor, point: PointOrClear::Point(reference_c) } => {
                let sensor = thermistor as usize;
                return self.add_point_and_refit(sensor, reference_c.f64(), &mut execute);
            }
            SessionRequest::Calibrate { thermistor, point: PointOrClear::Clear } => {
                self.clear_thermistor_calibration(thermistor as usize, &mut execute)?;
            }
            SessionRequest::Set { setting } => self.replace_setting(setting, &mut execute)?,
            SessionRequest::SetFluxSensor { sensor } => {
                self.set_flux_sensor(Some(sensor), &mut execute)?;
            }
            SessionRequest::NoFluxSensor => self.set_flux_sensor(None, &mut execute)?,
            SessionRequest::SetDisplaySurface { surface } => {
                self.set_display_surface(surface, &mut execute)?;
            }
            SessionRequest::NominalDisplaySurface => {
                self.set_display_surface(DisplaySurface::NOMINAL, &mut execute)?;
            }
            SessionRequest::QueryFlux => {
                let command::Reply::Flux(state) = execute(Command::Flux)? else {
                    return Ok(SessionReply::Flux(None));
                };
                let sensor_and_state = self.settings.flux_sensor.zip(state);
                return Ok(SessionReply::Flux(
                    sensor_and_state.map(|(sensor, state)| SensorWithState { sensor, state }),
                ));
            }
            SessionRequest::QueryDisplaySurface => {
                return Ok(SessionReply::DisplaySurface(self.settings.display));
            }
            SessionRequest::FluxZero => self.take_flux_zero(&mut execute)?,
            SessionRequest::TuneResult => {
                self.identify_and_set_tile(&mut execute)?;
                return Ok(self.tile_and_margins_reply());
            }
            SessionRequest::Margins => return Ok(self.tile_and_margins_reply()),
            SessionRequest::CountSettings => {
                let flux_sensor = usize::from(self.settings.flux_sensor.is_some());
                let display = usize::from(self.settings.display != DisplaySurface::NOMINAL);
                let lines = SETTING_LINES_ALWAYS + flux_sensor + display;
                return Ok(SessionReply::SettingsLines(SettingLines(lines as u32)));
            }
            SessionRequest::QuerySetting { number } => {
                let index = number.get().saturating_sub(1);
                return Ok(SessionReply::Setting(self.setting_at_line_index(index)));
            }
        }
        Ok(SessionReply::Done)
    }

    /// Replaces the part of the settings that a line holds.
    #[inline(never)]
    fn replace_setting(
        &mut self,
        setting: Setting,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), SessionError> {
        match setting {
            Setting::Steps { first, counts } => {
                let mut calibration = self.settings.calibration;
                let steps = calibration.steps_counts.iter_mut();
                for (step, count) in
                    steps.skip(first - FIRST_CALIBRATED_ADC_BORDER_INDEX).zip(&counts)
                {
                    *step = *count;
                }
                self.replace_calibration_and_clear_points(
                    calibration,
                    calibration,
                    0..DISPLAY_THERMISTOR_COUNT,
                    execute,
                )?;
            }
            Setting::Correction(thermistor, correction) => {
                let sensor = thermistor as usize;
                let (calibration, prior) =
                    self.calibration_and_fit_prior_with_correction(sensor, correction);
                self.replace_calibration_and_clear_points(
                    calibration,
                    prior,
                    sensor..sensor + 1,
                    execute,
                )?;
            }
            Setting::Tile(tile) => self.set_tile(tile, execute)?,
            Setting::FluxSensor(sensor) => self.set_flux_sensor(sensor, execute)?,
            Setting::DisplaySurface(display) => self.set_display_surface(display, execute)?,
        }
        Ok(())
    }

    /// Computes the tile's parameters from the response that the station has recorded during `tune`, and makes them the
    /// tile of the settings and of the station. Without a complete `tune`, if the response gives no tile, or if the
    /// station refuses the parameters, nothing changes.
    #[inline(never)]
    fn identify_and_set_tile(
        &mut self,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), SessionError> {
        let mut rows = [NormalEquationRow::default(); NORMAL_EQUATION_AND_STATISTICS_ROWS];
        for (i, row) in rows.iter_mut().enumerate() {
            let command::Reply::NormalEquation(sums) = execute(Command::NormalEquation(i))? else {
                return Err(Refused::NotTuned.into());
            };
            *row = sums;
        }
        let tile = tile_from_normal_equations(&rows).map_err(SessionError::Identification)?;
        Ok(self.set_tile(tile, execute)?)
    }

    /// Replaces the tile's parameters, and the controller gains that follow from them, in the station and in this
    /// session's settings (in RAM; only `save` writes them to flash). If the station refuses them, because it presents
    /// an object, nothing changes.
    #[inline(never)]
    fn set_tile(&mut self, tile: Tile, execute: &mut impl ExecuteOnStation) -> Result<(), Refused> {
        let mut settings = self.settings;
        settings.set_tile(tile);
        execute(Command::Retune(ControlParameters::new(&settings)))?;
        self.settings = settings;
        Ok(())
    }

    /// Replaces the heat-flux sensor in the station and in this session's settings (in RAM; only `save` writes them to flash).
    /// If the station refuses it, because it presents an object, nothing changes.
    #[inline(never)]
    fn set_flux_sensor(
        &mut self,
        sensor: Option<FluxSensor>,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        let parameters = sensor.as_ref().map(FluxParameters::new);
        execute(Command::FluxSensor(parameters))?;
        self.settings.flux_sensor = sensor;
        Ok(())
    }

    /// Replaces the surface of the display in the station and in this session's settings (in RAM; only `save` writes them to
    /// flash). If the station refuses it, because it presents an object, or the contact model cannot represent it with the chosen
    /// material, nothing changes.
    #[inline(never)]
    fn set_display_surface(
        &mut self,
        display: DisplaySurface,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), SessionError> {
        let [(_, any), ..] = MATERIALS;
        let material = match execute(Command::MaterialProperties)? {
            command::Reply::Material(Some(material)) => material,
            _ => any,
        };
        let chosen = ChosenMaterial::new("", &material, display.surface())
            .map_err(SessionError::ContactPair)?;
        execute(Command::DisplaySurface(chosen.pair))?;
        self.settings.display = display;
        Ok(())
    }

    /// Takes the mean code of half a second without flux as the zero of the heat-flux sensor.
    #[inline(never)]
    fn take_flux_zero(&mut self, execute: &mut impl ExecuteOnStation) -> Result<(), Refused> {
        const NO_SENSOR: Refused = Refused::NoFluxSensor("flux zero");
        let command::Reply::FluxZero(code) = execute(Command::FluxZero)? else {
            return Err(NO_SENSOR);
        };
        let mut sensor = self.settings.flux_sensor.ok_or(NO_SENSOR)?;
        sensor.zero_counts = code.mean_counts();
        let sensor = FluxSensor::from_array_rounded(sensor.to_array());
        self.set_flux_sensor(Some(sensor), execute)
    }

    #[inline(never)]
    fn tile_and_margins_reply(&self) -> SessionReply {
        let Settings { tile, gains, .. } = &self.settings;
        let margins = StabilityMargins::new(tile, gains);
        SessionReply::Tile(TileWithMargins {
            tile: *tile,
            phase_margin_deg: margins.phase_deg,
            gain_margin: margins.gain,
        })
    }

    /// Replaces the calibration in the station and in this session's settings (in RAM; only `save` writes them to
    /// flash). If the station refuses it, because it presents an object or runs the self-test, nothing changes. Not
    /// inlined, so that the copy of the settings takes stack in this function only.
    #[inline(never)]
    fn apply_calibration(
        &mut self,
        calibration: Calibration,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        let settings = Settings { calibration, ..self.settings };
        execute(Command::Calibrate(CalibrationTables::new(&settings)))?;
        self.settings = settings;
        Ok(())
    }

    /// Replaces the calibration in use and the prior of the calibration fit, and removes the calibration points of the
    /// thermistors with the indices `sensors`, because the new prior replaces what they contributed. If the station
    /// refuses the calibration, because it presents an object or runs the self-test, nothing changes.
    #[inline(never)]
    fn replace_calibration_and_clear_points(
        &mut self,
        calibration: Calibration,
        prior: Calibration,
        sensors: Range<usize>,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        self.apply_calibration(calibration, execute)?;
        self.prior = prior;
        sensors.for_each(|sensor| self.points.remove_points_of_sensor(sensor));
        Ok(())
    }

    /// Copies of the calibration in use and of the prior of the calibration fit, in this order, both with `correction`
    /// as the correction of the thermistor with the index `sensor`.
    fn calibration_and_fit_prior_with_correction(
        &self,
        sensor: usize,
        correction: Correction,
    ) -> (Calibration, Calibration) {
        let replaced = |mut calibration: Calibration| {
            if let Some(place) = calibration.corrections.get_mut(sensor) {
                *place = correction;
            }
            calibration
        };
        (replaced(self.settings.calibration), replaced(self.prior))
    }

    /// Removes the calibration points of the thermistor with the index `sensor`, and sets its correction to zero. If
    /// the corrections of both display thermistors are zero then, the converter's steps at its segment borders are set
    /// to zero, too, because only these two thermistors determine them. If the station refuses the calibration, nothing
    /// changes.
    #[inline(never)]
    fn clear_thermistor_calibration(
        &mut self,
        sensor: usize,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<(), Refused> {
        let (mut calibration, mut prior) =
            self.calibration_and_fit_prior_with_correction(sensor, Correction::default());
        let mut display = calibration.corrections.iter().take(DISPLAY_THERMISTOR_COUNT);
        if display.all(|correction| *correction == Correction::default()) {
            calibration.steps_counts = [0.0; CALIBRATED_ADC_BORDER_COUNT];
            prior.steps_counts = [0.0; CALIBRATED_ADC_BORDER_COUNT];
        }
        self.replace_calibration_and_clear_points(calibration, prior, sensor..sensor + 1, execute)
    }

    /// Adds a calibration point: the mean of the thermistor's converter sums over half a second, and the temperature of
    /// the reference thermometer, `reference_c`, °C. Then fits the calibration to all points, and uses it in station
    /// and settings. If no allowed calibration fits, or the station refuses it, the new point is removed again and
    /// nothing changes.
    #[inline(never)]
    fn add_point_and_refit(
        &mut self,
        sensor: usize,
        reference_c: f64,
        execute: &mut impl ExecuteOnStation,
    ) -> Result<SessionReply, SessionError> {
        let command::Reply::Average(average) = execute(Command::Average(sensor))? else {
            return Err(Refused::TooEarly.into());
        };
        let present_c = calibrated_temperature_c(&self.settings, sensor, average.mean_sum());
        self.points.add(sensor, &average, present_c, reference_c).map_err(SessionError::Point)?;
        let applied = fit_calibration(&self.settings, &self.prior, &self.points)
            .filter(|calibration| calibration.first_value_out_of_range().is_none())
            .ok_or(SessionError::Point(PointError::Contradicts))
            .and_then(|calibration| Ok(self.apply_calibration(calibration, execute)?));
        if applied.is_err() {
            self.points.remove_latest(sensor);
        }
        applied?;
        let points = self.points.of_sensor(sensor);
        let errors_k = points.iter().map(|point| {
            libm::fabs(
                calibrated_temperature_c(&self.settings, sensor, point.sum) - point.reference_c,
            )
        });
        Ok(SessionReply::PointAdded(PointsAndWorst {
            points: points.len() as u32,
            worst_mk: 1e3 * errors_k.fold(0.0, f64::max),
        }))
    }

    /// The content of one line of the settings by its index, 0 to 9: two lines of converter steps, five corrections,
    /// the tile, then a heat-flux sensor if there is one, and the surface of the display.
    #[inline(never)]
    fn setting_at_line_index(&self, index: usize) -> Setting {
        let calibration = &self.settings.calibration;
        if let Some(steps) =
            calibration.steps_counts.chunks(CONVERTER_STEPS_PER_LINE_MAX).nth(index)
        {
            return Setting::Steps {
                first: FIRST_CALIBRATED_ADC_BORDER_INDEX + index * CONVERTER_STEPS_PER_LINE_MAX,
                counts: heapless::Vec::from_slice(steps).unwrap_or_default(),
            };
        }
        let sensor = index - CONVERTER_STEPS_LINES;
        let mut thermistors = ThermistorId::ALL.iter().zip(&calibration.corrections);
        match thermistors.nth(sensor) {
            Some((thermistor, correction)) => Setting::Correction(*thermistor, *correction),
            None if index < SETTING_LINES_ALWAYS => Setting::Tile(self.settings.tile),
            None => match self.settings.flux_sensor {
                Some(sensor) if index == SETTING_LINES_ALWAYS => Setting::FluxSensor(Some(sensor)),
                _ => Setting::DisplaySurface(self.settings.display),
            },
        }
    }
}

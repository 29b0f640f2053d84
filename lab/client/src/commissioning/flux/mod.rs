//! Calibration of the heat-flux sensor by a phantom: a block of known effusivity that the display warms and cools.

mod fit;

use std::fmt;
use std::time::Duration;

use serde::Serialize;
use thermal_settings::FluxSensor;

use super::procedure::arm;
use super::{CommissionError, Surroundings};
use crate::client::{
    Client, Command, QueryState, ReceivedTelemetry, SessionRequest, StationRequest,
};
use crate::link::Link;
use fit::{Fit, STEP_S, Sample};

/// Effusivity of the phantom at 25 °C, W s½/(m² K), and its change, per K: water with 1 % of agar (`docs/flux.md`).
const GEL: (f64, f64) = (1585.0, 1.95);
/// Errors of the gain, fractions, one standard deviation each: the phantom's effusivity; the display's temperatures.
const GEL_ERROR: f64 = 5e-3;
const TEMPERATURE_ERROR: f64 = 2e-3;
/// Interval of the telemetry, ms, and its fields.
const STREAM_MS: u32 = (1e3 * STEP_S) as u32;
const FIELDS: [&str; 4] = ["room", "force", "flux", "surface"];
/// Time within which a device trips by what a person has moved.
const MOVED: Duration = Duration::from_millis(100);
/// Longest wait for a line of telemetry.
const LINE_TIMEOUT: Duration = Duration::from_millis(500);
/// Range of the room's temperature, °C: the display must reach both ends of the course.
const ROOM_C: (f64, f64) = (20.0, 33.0);
/// Largest difference of phantom and room, K: one that has not lain there for long enough is not as warm inside as at its surface.
const PHANTOM_FROM_ROOM_K: f64 = 0.5;
/// Time for which the display must have the room's temperature before, within this, s and K, and longest wait for that, s.
const ALONE_S: f64 = 2.0;
const ALONE_K: f64 = 0.1;
const ALONE_MAX_S: f64 = 60.0;
/// Time until display and phantom are at rest in contact, s.
const TOGETHER_S: f64 = 10.0;
/// The course after that: temperatures above the room's, K, and how long each, s. As far up as down, so that what changes with
/// temperature, in the phantom and in the sensor, cancels.
const COURSE: [(f64, f64); 4] = [(4.5, 8.0), (-4.5, 12.0), (4.5, 12.0), (0.0, 6.0)];
/// Rate of the display, K/s.
const RATE_K_S: f64 = 2.0;
/// Time before the course from which samples are fitted, s.
const FITTED_BEFORE_S: f64 = 2.0;
/// The display rests if its surface has not moved by more than this, K, in this time, s.
const RESTS_K: f64 = 0.03;
const RESTS_S: f64 = 1.0;
/// Least force of the phantom with its weight, N, and force without it.
const PRESSED_N: f64 = 1.0;
const FREE_N: f64 = 0.02;
/// Longest time from the landing to the end, s.
const RECORDED_MAX_S: f64 = 120.0;
/// Time from the landing within which Enter must be pressed, s: what follows lasts as long as rest and course.
const CONFIRMED_MAX_S: f64 =
    RECORDED_MAX_S - (TOGETHER_S + COURSE[0].1 + COURSE[1].1 + COURSE[2].1 + COURSE[3].1);
/// Gains over the designed one that a sound sensor on the right phantom has, and contact resistances, m² K/W, without the sensor's layer.
const GAIN: (f64, f64) = (0.75, 1.33);
const CONTACT_M2K_W: (f64, f64) = (-1e-5, 4e-4);
/// Largest RMS of the residuals, K.
const RESIDUAL_MAX_K: f64 = 0.03;

/// Where the phantom is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhantomPlace {
    /// In the room, whose temperature it has; nothing is on the display.
    Beside,
    /// On the display, with the weight on it.
    OnDisplay,
    /// Put away.
    Away,
}

impl PhantomPlace {
    /// All with their words on the line to simulated surroundings.
    pub const WORDS: [(&'static str, Self); 3] =
        [("beside", Self::Beside), ("on", Self::OnDisplay), ("away", Self::Away)];
}

/// What the phantom has shown of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FluxCalibration {
    /// Gain, counts of the converter (of 4096) per W/m².
    pub counts_per_w_m2: f64,
    /// Its error with that of the phantom, %, one standard deviation.
    pub gain_error_percent: f64,
    /// Code without flux, counts.
    pub zero_counts: f64,
    /// Contact resistance of the phantom, mm² K/W, without the sensor's layer.
    pub contact_mm2k_w: f64,
    /// RMS of what the fit leaves of the display's temperature, mK.
    pub residual_mk: f64,
    /// Mean force, N.
    pub force_n: f64,
    /// Temperature of the phantom before, °C.
    pub phantom_c: f64,
}

impl fmt::Display for FluxCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "gain {:.6} counts per W/m² within {:.2} % (one standard deviation), zero {:.2} counts; contact of the phantom {:.0} mm² K/W, {:.1} mK RMS off its half-space",
            self.counts_per_w_m2,
            self.gain_error_percent,
            self.zero_counts,
            self.contact_mm2k_w,
            self.residual_mk
        )
    }
}

/// Why the sensor is not calibrated. Its settings are as before, and the bridge is off.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FluxCalibrationError {
    /// There is no sensor.
    #[error("the device has no heat-flux sensor, or none is set (`flux set`)")]
    NoSensor,
    /// The sensor's code cannot be right.
    #[error("the heat-flux sensor's code is at a rail or does not change: look at its wires")]
    SensorFault,
    /// The device has tripped.
    #[error("the device has tripped: {0}")]
    Tripped(&'static str),
    /// Telemetry does not come, or lines of it are missing.
    #[error("telemetry of every {STREAM_MS} ms is needed; {0}")]
    Telemetry(String),
    /// The temperature of phantom or room is not known.
    #[error("the {0} thermistor has no reading")]
    Unknown(&'static str),
    /// The room is too warm or too cold.
    #[error(
        "the room has {0:.2} C; allowed are {least} to {most} C",
        least = ROOM_C.0,
        most = ROOM_C.1
    )]
    Room(f64),
    /// The phantom is too warm or too cold.
    #[error(
        "the phantom had {phantom_c:.2} C and the room {room_c:.2} C; allowed is a difference of {PHANTOM_FROM_ROOM_K} C. Let it lie beside the display for an hour"
    )]
    PhantomTemperature {
        /// The phantom before, °C.
        phantom_c: f64,
        /// The room, °C.
        room_c: f64,
    },
    /// Something is on the display before.
    #[error("{0:.2} N are on the display before the phantom; take it away")]
    NotFree(f64),
    /// The phantom is not on the display.
    #[error(
        "the phantom presses with {0:.2} N; it needs {PRESSED_N} N or more with its weight, until the end"
    )]
    NotPressed(f64),
    /// It was put on too long ago. Its value: seconds from then to the end of the course.
    #[error(
        "the phantom was put on {0:.0} s ago; press Enter within {CONFIRMED_MAX_S} s after that"
    )]
    TooLong(f64),
    /// No gain follows from what was read.
    #[error("the display's temperature does not depend on what the sensor reads: shorted wires?")]
    NoFlux,
    /// The gain is not that of a sound sensor on the right phantom.
    #[error(
        "the gain is {0:.2} of the designed one; allowed are {least} to {most}. Another phantom than the gel, or a broken sensor",
        least = GAIN.0, most = GAIN.1
    )]
    Gain(f64),
    /// The contact is not that of a gel.
    #[error(
        "the contact of the phantom has {0:.0} mm² K/W; allowed are {least:.0} to {most:.0}. Something between, air, or another phantom",
        least = 1e6 * CONTACT_M2K_W.0, most = 1e6 * CONTACT_M2K_W.1
    )]
    Contact(f64),
    /// The phantom is no half-space, or something else has happened.
    #[error(
        "the display was {0:.1} mK RMS off what a half-space makes; allowed are {most:.0}. A phantom that is too thin, or moved",
        most = 1e3 * RESIDUAL_MAX_K
    )]
    Residual(f64),
}

/// Calibrates zero and gain of the heat-flux sensor with a phantom, and tells the device: in RAM, until it is told to `save`. The
/// bridge is off afterwards. Thermistors and tile must be commissioned before.
///
/// The lag stays as it is: the device knows its display's temperature to some 10 ms only, while the display moves.
///
/// # Errors
/// The sensor is not calibrated; its settings are as before.
pub fn calibrate_flux<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    surroundings: &mut dyn Surroundings<L>,
) -> Result<FluxCalibration, CommissionError> {
    client.ask_finger(finger, &StationRequest::Abort)?;
    let report = client.flux_report(finger)?;
    let before = report.ok_or(FluxCalibrationError::NoSensor)?.sensor;
    let mut session = Session { client, finger, surroundings };
    let calibrated = session.calibrate();
    // Also after a failure. A link that is gone fails here, too.
    let ended = client.abort_and_end_stream(finger);
    match calibrated {
        Ok((sensor, calibration)) => {
            ended?;
            client.ask_finger(finger, &SessionRequest::flux_sensor(Some(sensor)))?;
            surroundings.move_phantom(client, PhantomPlace::Away)?;
            Ok(calibration)
        }
        Err(error) => {
            let _ignored = client.ask_finger(finger, &SessionRequest::flux_sensor(Some(before)));
            Err(error)
        }
    }
}

struct Session<'a, L> {
    client: &'a mut Client<L>,
    finger: Option<u8>,
    surroundings: &'a mut dyn Surroundings<L>,
}

impl<L: Link> Session<'_, L> {
    fn send(&mut self, command: &impl Command<Answer = ()>) -> Result<(), CommissionError> {
        Ok(self.client.ask_finger(self.finger, command)?)
    }

    fn calibrate(&mut self) -> Result<(FluxSensor, FluxCalibration), CommissionError> {
        (self.surroundings).move_phantom(self.client, PhantomPlace::Beside)?;
        // What was done to sink and thermistors before may have tripped it. A fault that is still present is refused.
        self.client.wait(MOVED)?;
        let state = self.client.ask_finger(self.finger, &QueryState)?.state;
        if state.fault().is_some() {
            self.send(&StationRequest::Clear)?;
        }
        self.send(&StationRequest::stream_fields(STREAM_MS, &FIELDS))?;
        let alone = self.receive(1.0)?;
        let room_c = mean(&alone, "room", |line| line.telemetry.room_c)?;
        if !(ROOM_C.0..=ROOM_C.1).contains(&room_c) {
            return Err(FluxCalibrationError::Room(room_c).into());
        }
        let force_n = mean(&alone, "force", |line| line.telemetry.force_n)?;
        if force_n > FREE_N {
            return Err(FluxCalibrationError::NotFree(force_n).into());
        }
        arm(self.client, self.finger)?;
        let at_c = |above_k: f64| (100.0 * (room_c + above_k)).round() / 100.0;
        self.send(&StationRequest::hold(at_c(0.0), Some(RATE_K_S)))?;
        self.settle(at_c(0.0))?;
        self.send(&SessionRequest::FluxZero)?;
        (self.surroundings).move_phantom(self.client, PhantomPlace::OnDisplay)?;
        // What has come while the phantom was put on, too.
        let mut lines = self.receive(TOGETHER_S)?;
        let from = lines.len();
        for (above_k, for_s) in COURSE {
            self.send(&StationRequest::hold(at_c(above_k), Some(RATE_K_S)))?;
            lines.extend(self.receive(for_s)?);
        }
        self.send(&StationRequest::Abort)?;
        self.fit(&lines, from, room_c)
    }

    /// Waits until the display has rested at this temperature, °C.
    fn settle(&mut self, at_c: f64) -> Result<(), CommissionError> {
        for _ in 0..(ALONE_MAX_S / ALONE_S) as u32 {
            let lines = self.receive(ALONE_S)?;
            let mut surfaces_c = lines.iter().filter_map(|line| line.telemetry.surface_c);
            if surfaces_c.all(|surface_c| (surface_c - at_c).abs() < ALONE_K) {
                return Ok(());
            }
        }
        Err(CommissionError::TooLong("hold"))
    }

    /// All lines that have come and come within this time, s.
    fn receive(&mut self, for_s: f64) -> Result<Vec<ReceivedTelemetry>, CommissionError> {
        let end = self.client.link().now() + Duration::from_secs_f64(for_s);
        let mut lines = Vec::new();
        while self.client.link().now() < end {
            let line = (self.client).next_telemetry_of(self.finger, LINE_TIMEOUT)?;
            let line = line.ok_or_else(|| {
                FluxCalibrationError::Telemetry(format!("none came in {LINE_TIMEOUT:?}"))
            })?;
            if let Some(fault) = line.telemetry.state.fault() {
                return Err(FluxCalibrationError::Tripped(fault.name()).into());
            }
            lines.push(line);
        }
        Ok(lines)
    }

    /// Fits what came since the phantom was put on; the course begins at line `from`.
    fn fit(
        &mut self,
        lines: &[ReceivedTelemetry],
        from: usize,
        room_c: f64,
    ) -> Result<(FluxSensor, FluxCalibration), CommissionError> {
        let force_n = |line: &ReceivedTelemetry| line.telemetry.force_n.unwrap_or(0.0);
        let landed = lines.iter().rposition(|line| force_n(line) < FREE_N).unwrap_or(0);
        let fitted_from = from.saturating_sub((FITTED_BEFORE_S / STEP_S) as usize);
        let pressed = lines.get(fitted_from..).unwrap_or_default();
        let least_n = pressed.iter().map(force_n).fold(f64::INFINITY, f64::min);
        if least_n < PRESSED_N || landed >= fitted_from {
            return Err(FluxCalibrationError::NotPressed(least_n).into());
        }
        let recorded = &lines[landed..];
        let recorded_s = STEP_S * recorded.len() as f64;
        if recorded_s > RECORDED_MAX_S {
            return Err(FluxCalibrationError::TooLong(recorded_s).into());
        }
        let samples = recorded.iter().skip(1).map(|line| {
            if line.lost_before > 0 {
                let lost = format!("{} are missing", line.lost_before);
                return Err(FluxCalibrationError::Telemetry(lost));
            }
            Ok(Sample {
                flux_w_m2: line.telemetry.flux_w_m2.ok_or(FluxCalibrationError::SensorFault)?,
                surface_c: line
                    .telemetry
                    .surface_c
                    .ok_or(FluxCalibrationError::Unknown("display"))?,
            })
        });
        let samples = samples.collect::<Result<Vec<_>, _>>()?;
        let report = self.client.flux_report(self.finger)?;
        let set = report.ok_or(FluxCalibrationError::NoSensor)?.sensor;
        let effusivity = GEL.0 + GEL.1 * (room_c - 25.0);
        let fitted = resting(&samples, fitted_from - landed);
        let fit = Fit::new(&samples, &fitted, effusivity).ok_or(FluxCalibrationError::NoFlux)?;
        let phantom_c = fit.phantom_c;
        let (gain, scatter) = fit.gain;
        let mut found = set;
        found.counts_per_w_m2 *= gain;
        let designed = found.counts_per_w_m2 / FluxSensor::DESIGNED.counts_per_w_m2;
        if !(GAIN.0..=GAIN.1).contains(&designed) {
            return Err(FluxCalibrationError::Gain(designed).into());
        }
        let contact_m2k_w = fit.resistance_m2k_w - 1e-6 * set.resistance_mm2k_w;
        if !(CONTACT_M2K_W.0..=CONTACT_M2K_W.1).contains(&contact_m2k_w) {
            return Err(FluxCalibrationError::Contact(1e6 * contact_m2k_w).into());
        }
        if (phantom_c - room_c).abs() > PHANTOM_FROM_ROOM_K {
            return Err(FluxCalibrationError::PhantomTemperature { phantom_c, room_c }.into());
        }
        if fit.residual_k > RESIDUAL_MAX_K {
            return Err(FluxCalibrationError::Residual(1e3 * fit.residual_k).into());
        }
        let gain_error = GEL_ERROR.hypot(TEMPERATURE_ERROR).hypot(scatter);
        let found = FluxSensor::from_array_rounded(found.to_array());
        let calibration = FluxCalibration {
            counts_per_w_m2: found.counts_per_w_m2,
            gain_error_percent: 100.0 * gain_error,
            zero_counts: found.zero_counts,
            contact_mm2k_w: 1e6 * contact_m2k_w,
            residual_mk: 1e3 * fit.residual_k,
            force_n: pressed.iter().map(force_n).sum::<f64>() / pressed.len() as f64,
            phantom_c,
        };
        Ok((found, calibration))
    }
}

/// Numbers of the samples from one on at which the display rests.
fn resting(samples: &[Sample], from: usize) -> Vec<usize> {
    let before = (RESTS_S / STEP_S) as usize;
    let moved_k = |n: usize| samples[n].surface_c - samples[n - before].surface_c;
    let all = from.max(before)..samples.len();
    all.filter(|&n| moved_k(n).abs() < RESTS_K).collect()
}

/// Mean of a reading.
fn mean(
    lines: &[ReceivedTelemetry],
    what: &'static str,
    of: impl Fn(&ReceivedTelemetry) -> Option<f64>,
) -> Result<f64, CommissionError> {
    let known: Vec<f64> = lines.iter().filter_map(of).collect();
    if known.is_empty() {
        return Err(FluxCalibrationError::Unknown(what).into());
    }
    Ok(known.iter().sum::<f64>() / known.len() as f64)
}

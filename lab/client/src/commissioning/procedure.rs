//! The steps of the procedure.

use std::time::Duration;

use thermal_device::StateName;
use thermal_device::safety::ThermistorId;
use thermal_settings::{CODES_PER_ADC_SEGMENT, Settings};

use super::{
    CalibrationPoint, CommissionError, CommissioningEvent, CommissioningRecord, FluxCalibration,
    Surroundings, calibrate_flux,
};
use crate::client::{
    Calibrate, Client, ClientError, CountSettings, DeviceRequest, IdentifiedTile, PointOrClear,
    QueryMargins, QuerySetting, QueryState, SessionRequest, StationRequest, TuneResult,
};
use crate::link::Link;

/// Range of the display's calibration, deg C; it includes the range of use.
const DISPLAY_C: (f64, f64) = (15.3, 41.7);
/// Time after power-up in which the device finds the zero of its force sensor, ms.
const START_MS: u64 = 500;
/// Distance of the calibration points from the borders of the converter's segments, codes.
const FROM_BORDER_CODES: u32 = 22;
/// Time that the display takes for a change of one degree, ms.
const MS_PER_DEGREE: f64 = 1000.0;
/// Required number of points of the display.
const POINTS_REQUIRED: usize = 9;
/// Required number of points of every other thermistor: those of a straight line that does not pass through all of them.
const LINE_POINTS_REQUIRED: usize = 3;
/// Settling time of the display at a point, ms, and interval and number of further attempts.
const SETTLE_MS: u64 = 2500;
const RETRY_MS: u64 = 800;
const RETRIES: u64 = 24;
/// Largest change of the reference between two attempts in the steady state, K: twice its noise and resolution.
const STEADY_K: f64 = 1.5e-3;
/// Timeout of tuning, s.
const TUNE_S: u32 = 70;
/// Timeout of a self-test, and the interval at which its end is polled, ms.
const SELF_TEST_MS: u64 = 3000;
const POLL_MS: u64 = 50;
/// Time in a bath, ms: the thermistor settles sooner, and the device needs this long to judge that it is steady.
const BATH_MS: u64 = 900;
/// Bath temperatures of skin and room thermistor and coolant temperatures of the sink, deg C, away from the converter's
/// steps.
const SKIN_C: [f64; 5] = [26.7, 29.3, 32.2, 35.0, 37.3];
const ROOM_C: [f64; 5] = [17.7, 20.5, 23.5, 26.7, 30.5];
const SINK_C: [f64; 5] = [17.7, 23.5, 29.3, 35.0, 40.7];

/// Calibrates all sensors of a device, or of one of its fingers, in its place of use, and makes it tune itself and store the
/// result. A heat-flux sensor is among them if one is set. If anything fails, the bridge is switched off.
///
/// # Errors
/// The device cannot be commissioned, or the person has ended the procedure.
pub fn commission<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    surroundings: &mut dyn Surroundings<L>,
) -> Result<CommissioningRecord, CommissionError> {
    let mut procedure = Procedure { client, finger, surroundings, points: Vec::new() };
    let done = procedure.run();
    if done.is_err() {
        // The reason why it failed is reported; a link that is gone fails here, too.
        let _ignored = client.ask_finger(finger, &StationRequest::Abort);
    }
    done
}

/// Calibrates the heat-flux sensor of a device that is commissioned, and makes it store the result, which is returned with the
/// settings as lines. If anything fails, the bridge is switched off, and the settings are as before.
///
/// # Errors
/// The sensor cannot be calibrated, or the person has ended the procedure.
pub fn commission_flux_sensor<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    surroundings: &mut dyn Surroundings<L>,
) -> Result<(FluxCalibration, Vec<String>), CommissionError> {
    let mut procedure = Procedure { client, finger, surroundings, points: Vec::new() };
    let found = procedure.calibrate_flux()?;
    Ok((found, procedure.save()?))
}

/// Sends lines of settings to a device, and returns the tile that it then reports. They are in use until it restarts, unless
/// it is told to `save` them.
///
/// # Errors
/// The device refuses a line, or reports other settings afterwards.
pub fn restore<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    lines: &[String],
) -> Result<IdentifiedTile, CommissionError> {
    for line in lines {
        match finger {
            Some(finger) => client.command(&format!("@{finger} {line}"))?,
            None => client.command(line)?,
        };
    }
    expect_settings(client, finger, lines)?;
    Ok(client.ask_finger(finger, &QueryMargins)?)
}

/// Checks that a device reports these lines.
fn expect_settings<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    lines: &[String],
) -> Result<(), CommissionError> {
    let reported = settings(client, finger)?;
    match lines.iter().find(|line| !reported.contains(line)) {
        Some(lost) => Err(CommissionError::NotRestored(lost.clone())),
        None => Ok(()),
    }
}

/// Makes a device, or one of its fingers, forget points and corrections of all thermistors until it restarts, with the bridge
/// off. A device that is commissioned again begins so.
///
/// # Errors
/// The device refuses.
pub fn clear_calibration<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
) -> Result<(), ClientError> {
    client.ask_finger(finger, &StationRequest::Abort)?;
    ThermistorId::ALL.iter().try_for_each(|one| {
        let point = PointOrClear::Clear;
        client.ask_finger(finger, &SessionRequest::Calibrate { thermistor: *one, point })
    })
}

/// All settings of a device or of one of its fingers, as lines.
///
/// # Errors
/// The device does not report them.
pub fn settings<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
) -> Result<Vec<String>, ClientError> {
    let lines = client.ask_finger(finger, &CountSettings)?.lines;
    (1..=lines as usize)
        .map(|number| {
            let line = client.ask_finger(finger, &QuerySetting { number: number.into() })?;
            Ok(line.to_string())
        })
        .collect()
}

/// Arms a device, which runs its self-test first if it has not yet, and waits until it is armed.
///
/// # Errors
/// The device refuses, trips, or is not armed in time.
pub fn arm<L: Link>(client: &mut Client<L>, finger: Option<u8>) -> Result<(), CommissionError> {
    client.ask_finger(finger, &StationRequest::Arm)?;
    for _ in 0..SELF_TEST_MS / POLL_MS {
        match client.ask_finger(finger, &QueryState)?.state {
            StateName::Armed => return Ok(()),
            StateName::SelfTest => client.wait(Duration::from_millis(POLL_MS))?,
            other => {
                let fault = other.fault().map_or("-", |fault| fault.name());
                return Err(CommissionError::NotArmed { state: other.name(), fault });
            }
        }
    }
    Err(CommissionError::TooLong("arm"))
}

struct Procedure<'a, L> {
    client: &'a mut Client<L>,
    finger: Option<u8>,
    surroundings: &'a mut dyn Surroundings<L>,
    points: Vec<CalibrationPoint>,
}

/// Display temperatures to hold, deg C, warmest first: near both ends of each segment of the converter.
fn hold_temperatures_c() -> Vec<f64> {
    let thermistor = Settings::default().thermistor;
    let (coldest_c, warmest_c) = DISPLAY_C;
    (0..4096 / CODES_PER_ADC_SEGMENT)
        .flat_map(|segment| {
            let border = segment * CODES_PER_ADC_SEGMENT;
            [border + FROM_BORDER_CODES, border + CODES_PER_ADC_SEGMENT - FROM_BORDER_CODES]
        })
        .map(|code| thermistor.temperature_c(f64::from(code) * 16.0))
        .filter(|t_c| (coldest_c..=warmest_c).contains(t_c))
        .collect()
}

impl<L: Link> Procedure<'_, L> {
    fn run(&mut self) -> Result<CommissioningRecord, CommissionError> {
        self.wait_ms(START_MS)?;
        arm(self.client, self.finger)?;
        self.start_step("tune, as far as sensors from the shelf allow");
        self.tune()?;
        self.start_step(
            "calibrate the display's thermistors, held at temperature after temperature",
        );
        self.surroundings.put_probe_on_display(self.client, true)?;
        self.calibrate_display()?;
        self.surroundings.put_probe_on_display(self.client, false)?;
        arm(self.client, self.finger)?;
        self.start_step("tune again, with calibrated sensors");
        let tile = self.tune()?;
        self.client.ask_finger(self.finger, &StationRequest::Abort)?;
        self.start_step("calibrate the skin's thermistor in a bath");
        self.calibrate_in_baths(ThermistorId::Skin, SKIN_C)?;
        self.start_step("calibrate the room's thermistor in a bath");
        self.calibrate_in_baths(ThermistorId::Room, ROOM_C)?;
        self.start_step("calibrate the sink's thermistor on coolants");
        self.calibrate_in_baths(ThermistorId::Sink, SINK_C)?;
        // Before the phantom, so that nothing else is lost if it fails.
        let mut settings = self.save()?;
        let mut flux = None;
        if self.client.flux_report(self.finger)?.is_some() {
            flux = Some(self.calibrate_flux()?);
            settings = self.save()?;
        }
        Ok(CommissioningRecord { settings, flux, points: std::mem::take(&mut self.points), tile })
    }

    fn calibrate_flux(&mut self) -> Result<FluxCalibration, CommissionError> {
        self.start_step("calibrate the heat-flux sensor with a phantom");
        let found = calibrate_flux(self.client, self.finger, self.surroundings)?;
        self.surroundings.notice(&CommissioningEvent::FluxCalibrated(found));
        Ok(found)
    }

    /// Makes the device store its settings, and returns them as lines.
    fn save(&mut self) -> Result<Vec<String>, CommissionError> {
        self.start_step("save what was found");
        let settings = settings(self.client, self.finger)?;
        self.client.ask(&DeviceRequest::Save)?;
        expect_settings(self.client, self.finger, &settings)?;
        Ok(settings)
    }

    fn start_step(&mut self, what: &'static str) {
        self.surroundings.notice(&CommissioningEvent::StepStarted(what));
    }

    fn wait_ms(&mut self, ms: u64) -> Result<(), CommissionError> {
        Ok(self.client.wait(Duration::from_millis(ms))?)
    }

    /// Makes the device identify its tile.
    fn tune(&mut self) -> Result<IdentifiedTile, CommissionError> {
        self.client.ask_finger(self.finger, &StationRequest::Tune)?;
        for _ in 0..TUNE_S {
            self.wait_ms(1000)?;
            match self.client.ask_finger(self.finger, &TuneResult) {
                Ok(tile) => {
                    self.surroundings.notice(&CommissioningEvent::TileIdentified(tile.clone()));
                    return Ok(tile);
                }
                Err(error)
                    if error.refusal().is_some_and(|why| why.starts_with("tuning goes on")) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Err(CommissionError::TooLong("tune"))
    }

    /// Calibrates both thermistors of the display, from warm to cold.
    fn calibrate_display(&mut self) -> Result<(), CommissionError> {
        let (mut points, mut check_points, mut why) = (0, 0, String::new());
        for hold_c in hold_temperatures_c() {
            let distance_k = (hold_c - self.reference_c(ThermistorId::Display)?).abs();
            // The decimals that a person at the bench is told.
            let sent_c = (hold_c * 100.0).round() / 100.0;
            self.client.ask_finger(self.finger, &StationRequest::hold(sent_c, None))?;
            self.surroundings.notice(&CommissioningEvent::HoldStarted(hold_c));
            self.wait_ms((distance_k * MS_PER_DEGREE) as u64 + SETTLE_MS)?;
            let mut before_c = f64::NAN;
            for _ in 0..RETRIES {
                let shown_c = self.reference_c(ThermistorId::Display)?;
                if (shown_c - before_c).abs() > STEADY_K || before_c.is_nan() {
                    before_c = shown_c;
                    why = format!("the reference thermometer shows {shown_c:.3} C, and moves");
                    self.wait_ms(RETRY_MS)?;
                    continue;
                }
                match self.calibrate_point(ThermistorId::Display)? {
                    None => {
                        points += 1;
                        match self.calibrate_point(ThermistorId::Check)? {
                            None => check_points += 1,
                            Some(refused) => why = refused,
                        }
                        break;
                    }
                    Some(refused) => why = refused,
                }
                self.wait_ms(RETRY_MS)?;
            }
        }
        require_points(ThermistorId::Display, points, POINTS_REQUIRED, why.clone())?;
        require_points(ThermistorId::Check, check_points, LINE_POINTS_REQUIRED, why)
    }

    /// Calibrates a thermistor in one bath after another; a point at a step of the converter may be refused.
    fn calibrate_in_baths(
        &mut self,
        thermistor: ThermistorId,
        baths_c: [f64; 5],
    ) -> Result<(), CommissionError> {
        let (mut points, mut why) = (0, String::new());
        for bath_c in baths_c {
            self.surroundings.put_into_bath(self.client, thermistor, bath_c)?;
            self.wait_ms(BATH_MS)?;
            loop {
                match self.calibrate_point(thermistor)? {
                    None => {
                        points += 1;
                        break;
                    }
                    Some(refused) => why = refused,
                }
                if !self.surroundings.reads_again(&why) {
                    break;
                }
            }
        }
        require_points(thermistor, points, LINE_POINTS_REQUIRED, why)
    }

    fn reference_c(&mut self, thermistor: ThermistorId) -> Result<f64, CommissionError> {
        Ok(self.surroundings.reference_c(self.client, thermistor)?)
    }

    /// Sends a calibration point; returns the reason if the device refuses it because the reading moves or lies at a step of
    /// the converter, or for another reason that another reading may remove.
    fn calibrate_point(
        &mut self,
        thermistor: ThermistorId,
    ) -> Result<Option<String>, CommissionError> {
        let reference_c = self.reference_c(thermistor)?;
        let sensor = thermistor.name();
        let command = Calibrate { thermistor, point: PointOrClear::Point(reference_c.into()) };
        match self.client.ask_finger(self.finger, &command) {
            Ok(fit) => {
                let point = CalibrationPoint {
                    sensor,
                    reference_c,
                    points: fit.points,
                    worst_mk: fit.worst_mk,
                };
                self.surroundings.notice(&CommissioningEvent::PointAccepted(point.clone()));
                self.points.push(point);
                Ok(None)
            }
            Err(error) => {
                let Some(why) = error.refusal() else {
                    return Err(error.into());
                };
                let passes = ["the reading moves", "at a step"];
                let passes = passes.iter().any(|begin| why.starts_with(begin));
                if !passes && !self.surroundings.reads_again(why) {
                    return Err(error.into());
                }
                let why = why.to_owned();
                self.surroundings
                    .notice(&CommissioningEvent::PointRefused { sensor, why: why.clone() });
                Ok(Some(why))
            }
        }
    }
}

/// Refuses a thermistor with too few points.
fn require_points(
    thermistor: ThermistorId,
    points: usize,
    needed: usize,
    why: String,
) -> Result<(), CommissionError> {
    if points < needed {
        let sensor = thermistor.name();
        return Err(CommissionError::FewPoints { sensor, points, needed, why });
    }
    Ok(())
}

//! The steps of the operator.

use thermal_settings::{CODES_PER_ADC_SEGMENT, Settings};

use super::bench::CommissioningBench;
use super::record::{CalibrationPoint, CommissioningEvent, CommissioningRecord, IdentifiedTile};
use super::{CommissionError, CommissioningSetup};
use crate::World;
use crate::engine::Engine;

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
/// Settling time of the display at a point, ms, and interval and number of further attempts.
const SETTLE_MS: u64 = 2500;
const RETRY_MS: u64 = 800;
const RETRIES: u64 = 24;
/// Largest change of the reference between two attempts in the steady state, K: twice its noise and resolution.
const STEADY_K: f64 = 1.5e-3;
/// Timeout of tuning, s.
const TUNE_S: u32 = 70;
/// Time in a bath, ms: the thermistor settles sooner, and the device needs this long to judge that it is steady.
const BATH_MS: u64 = 900;
/// Bath temperatures of skin and room thermistor and coolant temperatures of the sink, deg C, away from the converter's
/// steps.
const SKIN_C: [f64; 5] = [26.7, 29.3, 32.2, 35.0, 37.3];
const ROOM_C: [f64; 5] = [17.7, 20.5, 23.5, 26.7, 30.5];
const SINK_C: [f64; 5] = [17.7, 23.5, 29.3, 35.0, 40.7];

/// Calibrates all sensors of a device, which starts in its [place of use](CommissioningSetup::in_use), and makes it tune
/// itself and store the result. `watch` is called for each event.
///
/// # Errors
/// The device cannot be commissioned.
pub fn commission<E: Engine>(
    setup: &CommissioningSetup,
    engine: &mut E,
    watch: &mut dyn FnMut(&CommissioningEvent),
) -> Result<CommissioningRecord, CommissionError> {
    let mut operator = Operator {
        bench: CommissioningBench::new(engine, setup.params().host, setup.operator_seed()),
        watch,
        points: Vec::new(),
    };
    operator.bench.wait(START_MS)?;
    operator.bench.arm()?;
    operator.start_step("tune, as far as sensors from the shelf allow");
    operator.tune()?;
    operator
        .start_step("calibrate the display's thermistors, held at temperature after temperature");
    operator.calibrate_display()?;
    operator.bench.arm()?;
    operator.start_step("tune again, with calibrated sensors");
    let tile = operator.tune()?;
    operator.bench.command("abort")?;
    operator.start_step("calibrate the skin's thermistor in a bath");
    for bath_c in SKIN_C {
        operator.calibrate_in("skin", setup.skin_in_bath(bath_c)?, |_| bath_c)?;
    }
    operator.start_step("calibrate the room's thermistor in a bath");
    for bath_c in ROOM_C {
        operator.calibrate_in("room", setup.room_in_bath(bath_c)?, |_| bath_c)?;
    }
    operator.start_step("calibrate the sink's thermistor on coolants");
    for coolant_c in SINK_C {
        let sink_c = |world: &World| world.plant().sink_c();
        operator.calibrate_in("sink", setup.sink_on_coolant(coolant_c)?, sink_c)?;
    }
    operator.start_step("save what was found");
    let settings = operator.bench.settings()?;
    operator.bench.command("save")?;
    let reported = operator.bench.settings()?;
    if let Some(lost) = settings.iter().find(|line| !reported.contains(line)) {
        return Err(CommissionError::NotRestored(lost.clone()));
    }
    Ok(CommissioningRecord {
        settings,
        points: operator.points,
        tile,
    })
}

/// Restores a device from lines of settings and returns the tile that it then reports.
///
/// # Errors
/// The device refuses a line, or reports other settings afterwards.
pub fn restore<E: Engine>(
    setup: &CommissioningSetup,
    engine: &mut E,
    settings: &[String],
) -> Result<IdentifiedTile, CommissionError> {
    let mut bench = CommissioningBench::new(engine, setup.params().host, setup.operator_seed());
    bench.wait(10)?;
    for line in settings {
        bench.command(line)?;
    }
    let reported = bench.settings()?;
    if let Some(lost) = settings.iter().find(|line| !reported.contains(line)) {
        return Err(CommissionError::NotRestored(lost.clone()));
    }
    let line = "margins";
    IdentifiedTile::parse(line, &bench.command(line)?)
}

/// The operator at the bench.
struct Operator<'a, E> {
    bench: CommissioningBench<'a, E>,
    watch: &'a mut dyn FnMut(&CommissioningEvent),
    points: Vec<CalibrationPoint>,
}

/// Display temperatures to hold, deg C, warmest first: near both ends of each segment of the converter.
fn hold_temperatures_c() -> Vec<f64> {
    let thermistor = Settings::default().thermistor;
    let (coldest_c, warmest_c) = DISPLAY_C;
    (0..4096 / CODES_PER_ADC_SEGMENT)
        .flat_map(|segment| {
            let border = segment * CODES_PER_ADC_SEGMENT;
            [
                border + FROM_BORDER_CODES,
                border + CODES_PER_ADC_SEGMENT - FROM_BORDER_CODES,
            ]
        })
        .map(|code| thermistor.temperature_c(f64::from(code) * 16.0))
        .filter(|t_c| (coldest_c..=warmest_c).contains(t_c))
        .collect()
}

impl<E: Engine> Operator<'_, E> {
    fn start_step(&mut self, what: &'static str) {
        (self.watch)(&CommissioningEvent::StepStarted(what));
    }

    /// Makes the device identify its tile.
    fn tune(&mut self) -> Result<IdentifiedTile, CommissionError> {
        self.bench.command("tune")?;
        let line = "tune result";
        for _ in 0..TUNE_S {
            self.bench.wait(1000)?;
            let answer = self.bench.query(line)?;
            if answer.starts_with("ok") {
                let tile = IdentifiedTile::parse(line, &answer)?;
                (self.watch)(&CommissioningEvent::TileIdentified(tile));
                return Ok(tile);
            }
            if !answer.starts_with("err tuning goes on") {
                let line = line.into();
                return Err(CommissionError::Refused { line, answer });
            }
        }
        Err(CommissionError::Silent(line.into()))
    }

    /// Calibrates both thermistors of the display, from warm to cold.
    fn calibrate_display(&mut self) -> Result<(), CommissionError> {
        let display_c = |world: &World| world.plant().display_c();
        let (mut points, mut why) = (0, String::new());
        for hold_c in hold_temperatures_c() {
            let distance_k = (hold_c - self.bench.reference_c(display_c)).abs();
            self.bench.command(&format!("hold {hold_c:.2}"))?;
            self.bench
                .wait((distance_k * MS_PER_DEGREE) as u64 + SETTLE_MS)?;
            let mut before_c = f64::NAN;
            for _ in 0..RETRIES {
                let shown_c = self.bench.reference_c(display_c);
                if (shown_c - before_c).abs() > STEADY_K || before_c.is_nan() {
                    before_c = shown_c;
                    why = format!("the reference thermometer shows {shown_c:.3} C, and moves");
                    self.bench.wait(RETRY_MS)?;
                    continue;
                }
                match self.calibrate_point("display", display_c)? {
                    None => {
                        points += 1;
                        self.calibrate_point("check", display_c)?;
                        break;
                    }
                    Some(refused) => why = refused,
                }
                self.bench.wait(RETRY_MS)?;
            }
        }
        if points < POINTS_REQUIRED {
            return Err(CommissionError::FewPoints {
                points,
                needed: POINTS_REQUIRED,
                why,
            });
        }
        Ok(())
    }

    /// Calibrates one point in another world; a point at a step of the converter may be refused.
    fn calibrate_in(
        &mut self,
        sensor: &'static str,
        world: World,
        truth: impl Fn(&World) -> f64,
    ) -> Result<(), CommissionError> {
        self.bench.move_to(world);
        self.bench.wait(BATH_MS)?;
        self.calibrate_point(sensor, truth)?;
        Ok(())
    }

    /// Sends a calibration point; returns the answer if the device refuses it because the reading moves or lies at a step
    /// of the converter.
    fn calibrate_point(
        &mut self,
        sensor: &'static str,
        truth: impl Fn(&World) -> f64,
    ) -> Result<Option<String>, CommissionError> {
        let reference_c = self.bench.reference_c(truth);
        let line = format!("calibrate {sensor} {reference_c:.3}");
        let answer = self.bench.query(&line)?;
        if answer.starts_with("ok") {
            let point = CalibrationPoint::parse(sensor, reference_c, &line, &answer)?;
            (self.watch)(&CommissioningEvent::PointAccepted(point.clone()));
            self.points.push(point);
            return Ok(None);
        }
        let recoverable = ["err the reading moves", "err at a step"];
        if recoverable
            .iter()
            .any(|beginning| answer.starts_with(beginning))
        {
            (self.watch)(&CommissioningEvent::PointRefused {
                sensor,
                answer: answer.clone(),
            });
            return Ok(Some(answer));
        }
        Err(CommissionError::Refused { line, answer })
    }
}

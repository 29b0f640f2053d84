//! What the operator does, step by step.

use thermal_settings::{SEGMENT_CODES, Settings};

use super::bench::CommissioningBench;
use super::record::{CalibrationPoint, CommissioningEvent, CommissioningRecord, IdentifiedTile};
use super::{CommissionError, CommissioningSetup};
use crate::World;
use crate::engine::Engine;

/// Display temperatures to calibrate at, deg C; within them lies what the display is used for.
const DISPLAY_C: (f64, f64) = (15.3, 41.7);
/// Time for a device that was just switched on to find its force sensor's zero, ms.
const START_MS: u64 = 500;
/// Codes from a border of the converter's segments to the points beside it.
const FROM_BORDER_CODES: u32 = 22;
/// Time that a held display takes for each degree, ms.
const DEGREE_MS: f64 = 1000.0;
/// Fewest points of the display.
const NEEDED: usize = 9;
/// Time that the display is given to come to rest at a point, and how much longer at most, ms.
const SETTLE_MS: u64 = 2500;
const RETRY_MS: u64 = 800;
const RETRIES: u64 = 24;
/// At rest, the reference thermometer moves no more than this in that time, K: twice its noise and resolution.
const REST_K: f64 = 1.5e-3;
/// The longest that tuning takes, s.
const TUNE_S: u32 = 70;
/// A thermistor in a bath has come to rest long before; so long does the device watch, ms.
const BATH_MS: u64 = 900;
/// Baths of the skin's and the room's thermistor and coolants of the sink, deg C: away from the converter's steps.
const SKIN_C: [f64; 5] = [26.7, 29.3, 32.2, 35.0, 37.3];
const ROOM_C: [f64; 5] = [17.7, 20.5, 23.5, 26.7, 30.5];
const SINK_C: [f64; 5] = [17.7, 23.5, 29.3, 35.0, 40.7];

/// Calibrates all sensors of the device on an engine, which is where it is [used](CommissioningSetup::in_use), and has it tune
/// itself and keep what was found; `watch` hears of each step.
///
/// # Errors
/// The device cannot be commissioned.
pub fn commission<E: Engine>(
    plants: &CommissioningSetup,
    engine: &mut E,
    watch: &mut dyn FnMut(&CommissioningEvent),
) -> Result<CommissioningRecord, CommissionError> {
    let mut operator = Operator {
        bench: CommissioningBench::new(engine, plants.params().host, plants.operator_seed()),
        watch,
        points: Vec::new(),
    };
    operator.bench.wait(START_MS)?;
    operator.bench.arm()?;
    operator.begin("tune, as far as sensors from the shelf allow");
    operator.tune()?;
    operator.begin("calibrate the display's thermistors, held at temperature after temperature");
    operator.display()?;
    operator.bench.arm()?;
    operator.begin("tune again, with calibrated sensors");
    let tile = operator.tune()?;
    operator.bench.tell("abort")?;
    operator.begin("calibrate the skin's thermistor in a bath");
    for bath_c in SKIN_C {
        operator.bench.move_to(plants.skin_in_bath(bath_c)?);
        operator.bench.wait(BATH_MS)?;
        // Only what lies at a step of the converter is refused here, and may be.
        operator.point("skin", |_| bath_c)?;
    }
    operator.begin("calibrate the room's thermistor in a bath");
    for bath_c in ROOM_C {
        operator.bench.move_to(plants.room_in_bath(bath_c)?);
        operator.bench.wait(BATH_MS)?;
        operator.point("room", |_| bath_c)?;
    }
    operator.begin("calibrate the sink's thermistor on coolants");
    for coolant_c in SINK_C {
        operator.bench.move_to(plants.sink_on_coolant(coolant_c)?);
        operator.bench.wait(BATH_MS)?;
        operator.point("sink", |world| world.plant().sink_c())?;
    }
    operator.begin("save what was found");
    let settings = operator.bench.settings()?;
    operator.bench.tell("save")?;
    let has = operator.bench.settings()?;
    if let Some(lost) = settings.iter().find(|line| !has.contains(line)) {
        return Err(CommissionError::NotRestored(lost.clone()));
    }
    Ok(CommissioningRecord {
        settings,
        points: operator.points,
        tile,
    })
}

/// Sends settings to a device as somebody does who has kept the lines, and gives the tile that it then has.
///
/// # Errors
/// The device refuses a line, or has other settings than those afterwards.
pub fn restore<E: Engine>(
    plants: &CommissioningSetup,
    engine: &mut E,
    settings: &[String],
) -> Result<IdentifiedTile, CommissionError> {
    let mut bench = CommissioningBench::new(engine, plants.params().host, plants.operator_seed());
    bench.wait(10)?;
    for line in settings {
        bench.tell(line)?;
    }
    let has = bench.settings()?;
    if let Some(lost) = settings.iter().find(|line| !has.contains(line)) {
        return Err(CommissionError::NotRestored(lost.clone()));
    }
    let line = "margins";
    IdentifiedTile::parse(line, &bench.tell(line)?)
}

/// Who does it, step by step.
struct Operator<'a, E> {
    bench: CommissioningBench<'a, E>,
    watch: &'a mut dyn FnMut(&CommissioningEvent),
    points: Vec<CalibrationPoint>,
}

/// Display temperatures to hold, deg C, warmest first: near both ends of each of the converter's segments.
fn holds() -> Vec<f64> {
    let thermistor = Settings::default().thermistor;
    let (coldest_c, warmest_c) = DISPLAY_C;
    (0..4096 / SEGMENT_CODES)
        .flat_map(|segment| {
            let border = segment * SEGMENT_CODES;
            [
                border + FROM_BORDER_CODES,
                border + SEGMENT_CODES - FROM_BORDER_CODES,
            ]
        })
        .map(|code| thermistor.temperature_c(f64::from(code) * 16.0))
        .filter(|t_c| (coldest_c..=warmest_c).contains(t_c))
        .collect()
}

impl<E: Engine> Operator<'_, E> {
    fn begin(&mut self, what: &'static str) {
        (self.watch)(&CommissioningEvent::StepStarted(what));
    }

    /// Lets the device find out about its tile.
    fn tune(&mut self) -> Result<IdentifiedTile, CommissionError> {
        self.bench.tell("tune")?;
        let line = "tune result";
        for _ in 0..TUNE_S {
            self.bench.wait(1000)?;
            let answer = self.bench.ask(line)?;
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

    /// Both of the display's thermistors, from warm to cold.
    fn display(&mut self) -> Result<(), CommissionError> {
        let display_c = |world: &World| world.plant().display_c();
        let (mut points, mut why) = (0, String::new());
        for hold_c in holds() {
            let away_k = (hold_c - self.bench.reference_c(display_c)).abs();
            self.bench.tell(&format!("hold {hold_c:.2}"))?;
            self.bench.wait((away_k * DEGREE_MS) as u64 + SETTLE_MS)?;
            let mut before_c = f64::NAN;
            for _ in 0..RETRIES {
                let shown_c = self.bench.reference_c(display_c);
                if (shown_c - before_c).abs() > REST_K || before_c.is_nan() {
                    before_c = shown_c;
                    why = format!("the reference thermometer shows {shown_c:.3} C, and moves");
                    self.bench.wait(RETRY_MS)?;
                    continue;
                }
                match self.point("display", display_c)? {
                    None => {
                        points += 1;
                        self.point("check", display_c)?;
                        break;
                    }
                    Some(refused) => why = refused,
                }
                self.bench.wait(RETRY_MS)?;
            }
        }
        if points < NEEDED {
            return Err(CommissionError::FewPoints {
                points,
                needed: NEEDED,
                why,
            });
        }
        Ok(())
    }

    /// Tells the device a point; why it was not taken, if the reading moves or lies at a step of the converter.
    fn point(
        &mut self,
        sensor: &'static str,
        truth: impl Fn(&World) -> f64,
    ) -> Result<Option<String>, CommissionError> {
        let reference_c = self.bench.reference_c(truth);
        let line = format!("calibrate {sensor} {reference_c:.3}");
        let answer = self.bench.ask(&line)?;
        if answer.starts_with("ok") {
            let point = CalibrationPoint::parse(sensor, reference_c, &line, &answer)?;
            (self.watch)(&CommissioningEvent::PointAccepted(point.clone()));
            self.points.push(point);
            return Ok(None);
        }
        let may_be = ["err the reading moves", "err at a step"];
        if may_be.iter().any(|beginning| answer.starts_with(beginning)) {
            (self.watch)(&CommissioningEvent::PointRefused {
                sensor,
                answer: answer.clone(),
            });
            return Ok(Some(answer));
        }
        Err(CommissionError::Refused { line, answer })
    }
}

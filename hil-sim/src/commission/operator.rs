//! What the operator does, step by step.

use thermal_display::settings::{SEGMENT_CODES, Settings};

use super::bench::Bench;
use super::{CommissionError, Plants};
use crate::engine::Engine;
use crate::world::World;

/// Display temperatures to calibrate at, deg C; within them lies what the display is used for.
const DISPLAY_C: (f64, f64) = (16.3, 41.7);
/// Codes from a border of the converter's segments to the points beside it.
const FROM_BORDER_CODES: u32 = 22;
/// Time for each degree on the way to the warmest point, ms.
const APPROACH_MS: u64 = 400;
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

/// Calibrates all sensors of the device on an engine, which is where it is [used](Plants::at_work), and gives its
/// settings as lines.
///
/// # Errors
/// The device cannot be commissioned.
pub fn commission<E: Engine>(plants: &Plants, engine: &mut E) -> Result<Vec<String>, CommissionError> {
    let mut bench = Bench::new(engine, plants.params().host, plants.operator_seed());
    bench.wait(10)?;
    bench.tell("arm")?;
    tune(&mut bench)?;
    display(&mut bench)?;
    bench.tell("arm")?;
    tune(&mut bench)?;
    bench.tell("abort")?;
    for bath_c in SKIN_C {
        bench.move_to(plants.skin_in_bath(bath_c)?);
        bench.wait(BATH_MS)?;
        // Only what lies at a step of the converter is refused here, and may be.
        point(&mut bench, "skin", |_| bath_c)?;
    }
    for bath_c in ROOM_C {
        bench.move_to(plants.room_in_bath(bath_c)?);
        bench.wait(BATH_MS)?;
        point(&mut bench, "room", |_| bath_c)?;
    }
    for coolant_c in SINK_C {
        bench.move_to(plants.sink_on_coolant(coolant_c)?);
        bench.wait(BATH_MS)?;
        point(&mut bench, "sink", |world| world.plant().sink_c())?;
    }
    let lines = bench.tell("settings")?;
    let lines: usize = lines.trim_start_matches("lines=").parse().unwrap_or(0);
    (1..=lines)
        .map(|line| bench.tell(&format!("settings {line}")))
        .collect()
}

/// Lets the device find out about its tile.
fn tune<E: Engine>(bench: &mut Bench<'_, E>) -> Result<(), CommissionError> {
    bench.tell("tune")?;
    for _ in 0..TUNE_S {
        bench.wait(1000)?;
        let line = "tune result";
        let answer = bench.ask(line)?;
        if answer.starts_with("ok") {
            return Ok(());
        }
        if !answer.starts_with("err tuning goes on") {
            let line = line.into();
            return Err(CommissionError::Refused { line, answer });
        }
    }
    Err(CommissionError::Silent("tune result".into()))
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

/// Both of the display's thermistors, from warm to cold.
fn display<E: Engine>(bench: &mut Bench<'_, E>) -> Result<(), CommissionError> {
    let (mut points, mut why) = (0, String::new());
    // Two thermistors of different lags part when the display moves fast, so it goes to the warmest point by steps.
    let from_c = bench.reference_c(|world| world.plant().display_c());
    for approach_c in from_c as u32..=DISPLAY_C.1 as u32 {
        bench.tell(&format!("hold {approach_c}"))?;
        bench.wait(APPROACH_MS)?;
    }
    for hold_c in holds() {
        bench.tell(&format!("hold {hold_c:.2}"))?;
        bench.wait(SETTLE_MS)?;
        let mut before_c = f64::NAN;
        for _ in 0..RETRIES {
            let shown_c = bench.reference_c(|world| world.plant().display_c());
            if (shown_c - before_c).abs() > REST_K || before_c.is_nan() {
                before_c = shown_c;
                why = format!("the reference thermometer shows {shown_c:.3} C, and moves");
                bench.wait(RETRY_MS)?;
                continue;
            }
            match point(bench, "display", |world| world.plant().display_c())? {
                None => {
                    points += 1;
                    point(bench, "check", |world| world.plant().display_c())?;
                    break;
                }
                Some(refused) => why = refused,
            }
            bench.wait(RETRY_MS)?;
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
fn point<E: Engine>(
    bench: &mut Bench<'_, E>,
    sensor: &str,
    truth: impl Fn(&World) -> f64,
) -> Result<Option<String>, CommissionError> {
    let line = format!("calibrate {sensor} {:.3}", bench.reference_c(truth));
    let answer = bench.ask(&line)?;
    if answer.starts_with("ok") {
        return Ok(None);
    }
    let may_be = ["err the reading moves", "err at a step"];
    if may_be.iter().any(|beginning| answer.starts_with(beginning)) {
        return Ok(Some(answer));
    }
    Err(CommissionError::Refused { line, answer })
}

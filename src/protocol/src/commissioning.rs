//! Lines that commission the device.

use thermal_commissioning::{Request, SENSORS, SETTINGS_LINES, STEPS_A_LINE};
use thermal_settings::{
    BORDERS, CORRECTION_RANGES, Calibration, Correction, FIRST_BORDER, Range, STEP_RANGE,
    TILE_RANGES, Tile, rounded,
};

use crate::Error;
use crate::command::number;

static REFERENCE: Range = Range {
    name: "reference temperature",
    unit: "C",
    min: 0.0,
    max: 60.0,
};
static LINE: Range = Range {
    name: "line of settings",
    unit: "(whole)",
    min: 1.0,
    max: SETTINGS_LINES as f64,
};
static BORDER: Range = Range {
    name: "border",
    unit: "(whole)",
    min: FIRST_BORDER as f64,
    max: (FIRST_BORDER + BORDERS - 1) as f64,
};
fn decimal<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    expected: &'static Range,
) -> Result<f64, Error> {
    number(words, expected).map(|value| value.to_num())
}

fn whole<'a>(
    words: &mut (impl Iterator<Item = &'a str> + Clone),
    expected: &'static Range,
) -> Result<usize, Error> {
    let word = words.clone().next().unwrap_or_default();
    let value = number(words, expected)?;
    if value.frac() == 0 {
        Ok(value.to_num())
    } else {
        Err(Error::OutOfRange(expected, word.into()))
    }
}

fn sensor<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<usize, Error> {
    let name = words.next().ok_or(Error::Missing("sensor"))?;
    let known = SENSORS.iter().position(|known| *known == name);
    known.ok_or(Error::UnknownSensor(name.into()))
}

pub fn calibrate<'a>(
    words: &mut (impl Iterator<Item = &'a str> + Clone),
) -> Result<Request, Error> {
    let sensor = sensor(words)?;
    if words.clone().next() == Some("clear") {
        words.next();
        return Ok(Request::Clear { sensor });
    }
    let reference_c = decimal(words, &REFERENCE)?;
    Ok(Request::Point {
        sensor,
        reference_c,
    })
}

pub fn settings<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> Result<Request, Error> {
    if words.clone().next().is_none() {
        return Ok(Request::Settings(None));
    }
    Ok(Request::Settings(Some(whole(words, &LINE)?)))
}

pub fn set<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> Result<Request, Error> {
    match words.next().ok_or(Error::Missing("setting"))? {
        "steps" => {
            let first = whole(words, &BORDER)?;
            let mut counts = heapless::Vec::new();
            while counts.is_empty() || words.clone().next().is_some() {
                if counts.len() == STEPS_A_LINE || first + counts.len() == FIRST_BORDER + BORDERS {
                    break;
                }
                let _ = counts.push(rounded(
                    decimal(words, &STEP_RANGE)?,
                    Calibration::STEP_DECIMALS,
                ));
            }
            Ok(Request::SetSteps { first, counts })
        }
        "correction" => {
            let sensor = sensor(words)?;
            let mut values = [0.0; 3];
            for (value, expected) in values.iter_mut().zip(&CORRECTION_RANGES) {
                *value = decimal(words, expected)?;
            }
            let [offset_k, slope, curvature_1_k] = values;
            let correction = Correction {
                offset_k,
                slope,
                curvature_1_k,
            };
            Ok(Request::SetCorrection {
                sensor,
                correction: correction.rounded(),
            })
        }
        "tile" => {
            let mut values = [0.0; TILE_RANGES.len()];
            for (value, expected) in values.iter_mut().zip(&TILE_RANGES) {
                *value = decimal(words, expected)?;
            }
            Ok(Request::SetTile(Tile::from_array(values)))
        }
        other => Err(Error::UnknownSetting(other.into())),
    }
}

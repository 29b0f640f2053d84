//! Lines that commission the device.

use super::Order;
use crate::protocol::{Error, Number, number};
use crate::sense::THERMISTORS;
use crate::settings::{BORDERS, Calibration, Correction, FIRST_BORDER, Tile, rounded};

/// The thermistors' words.
pub const SENSORS: [&str; THERMISTORS] = ["display", "check", "sink", "skin", "room"];
/// Steps on one line.
pub const STEPS_A_LINE: usize = 7;

/// A line of commissioning.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// `calibrate SENSOR CELSIUS`: what the reference thermometer says.
    Point {
        /// Which thermistor.
        sensor: usize,
        /// The reference thermometer, °C.
        reference_c: f64,
    },
    /// `calibrate SENSOR clear`: back to the class values.
    Clear {
        /// Which thermistor.
        sensor: usize,
    },
    /// `settings`: how many lines; `settings N`: one of them.
    Settings(Option<usize>),
    /// `set steps BORDER COUNTS...`: up to seven of the converter's steps.
    SetSteps {
        /// The first border.
        first: usize,
        /// Steps from there on, counts.
        counts: heapless::Vec<f64, STEPS_A_LINE>,
    },
    /// `set correction SENSOR OFFSET SLOPE CURVATURE`.
    SetCorrection {
        /// Which thermistor.
        sensor: usize,
        /// Its correction.
        correction: Correction,
    },
    /// `set tile GAIN JOULE LEAK LAG DEAD`.
    SetTile(Tile),
    /// `tune result`.
    Tuned,
    /// `margins`.
    Margins,
    /// `save` or `forget`, for [`super::Desk`].
    Keep(Order),
}

static REFERENCE: Number = Number {
    name: "reference temperature",
    unit: "C",
    min: 0.0,
    max: 60.0,
};
static LINE: Number = Number {
    name: "line of settings",
    unit: "(whole)",
    min: 1.0,
    max: super::service::SETTINGS_LINES as f64,
};
static BORDER: Number = Number {
    name: "border",
    unit: "(whole)",
    min: FIRST_BORDER as f64,
    max: (FIRST_BORDER + BORDERS - 1) as f64,
};
static STEP: Number = Number {
    name: "step",
    unit: "counts",
    min: -4.0,
    max: 4.0,
};
/// Together at most 2.5 K within the calibrated range: parts of this class need a tenth of it, and no line can hide a
/// display from the guard that is hotter than that, and 0.2 K of [steps](crate::sense::Steps), beyond its limit.
static CORRECTION: [Number; 3] = [
    Number {
        name: "offset",
        unit: "K",
        min: -1.2,
        max: 1.2,
    },
    Number {
        name: "slope",
        unit: "K/K",
        min: -0.05,
        max: 0.05,
    },
    Number {
        name: "curvature",
        unit: "1/K",
        min: -0.002,
        max: 0.002,
    },
];
/// In the order of [`Tile::to_array`].
pub static TILE: [Number; 5] = [
    Number {
        name: "gain",
        unit: "K/s/A",
        min: 0.1,
        max: 15.0,
    },
    Number {
        name: "Joule term",
        unit: "1/A",
        min: 0.0,
        max: 0.5,
    },
    Number {
        name: "leak",
        unit: "1/s",
        min: 0.0,
        max: 5.0,
    },
    Number {
        name: "lag",
        unit: "s",
        min: 0.001,
        max: 5.0,
    },
    Number {
        name: "dead time",
        unit: "s",
        min: 0.0,
        max: 1.0,
    },
];

impl Request {
    /// Reads a line if it is one of commissioning; `None` if it is another command's.
    ///
    /// # Errors
    /// What is wrong with the line, and what is allowed.
    pub fn parse(line: &str) -> Option<Result<Self, Error>> {
        let mut words = line.split_ascii_whitespace();
        let parsed = match words.next()? {
            "calibrate" => calibrate(&mut words),
            "settings" => settings(&mut words),
            "set" => set(&mut words),
            "margins" => Ok(Self::Margins),
            "save" => Ok(Self::Keep(Order::Save)),
            "forget" => Ok(Self::Keep(Order::Forget)),
            "tune" => match words.next()? {
                "result" => Ok(Self::Tuned),
                other => Err(Error::Extra(other.into())),
            },
            _ => return None,
        };
        Some(parsed.and_then(|request| match words.next() {
            None => Ok(request),
            Some(extra) => Err(Error::Extra(extra.into())),
        }))
    }
}

fn decimal<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    expected: &'static Number,
) -> Result<f64, Error> {
    number(words, expected).map(|value| value.to_num())
}

fn whole<'a>(
    words: &mut (impl Iterator<Item = &'a str> + Clone),
    expected: &'static Number,
) -> Result<usize, Error> {
    let word = words.clone().next().unwrap_or_default();
    let value = number(words, expected)?;
    if value.frac() == 0 {
        Ok(value.to_num())
    } else {
        Err(Error::OutOfRange(expected, word.into()))
    }
}

/// Whether the lines of a calibration are within what they may say.
pub fn is_settable(calibration: &Calibration) -> bool {
    calibration_beyond(calibration).is_none()
}

/// The first value of a calibration that no line could set, and what is allowed.
pub fn calibration_beyond(calibration: &Calibration) -> Option<(&'static Number, f64)> {
    let steps = calibration.steps_counts.iter().map(|step| (&STEP, *step));
    let corrections = calibration.corrections.iter().flat_map(|correction| {
        let Correction {
            offset_k,
            slope,
            curvature_1_k,
        } = *correction;
        CORRECTION.iter().zip([offset_k, slope, curvature_1_k])
    });
    steps.chain(corrections).find(is_beyond)
}

/// The first value of a tile that no line could set, and what is allowed.
pub fn tile_beyond(tile: &Tile) -> Option<(&'static Number, f64)> {
    TILE.iter().zip(tile.to_array()).find(is_beyond)
}

fn is_beyond((allowed, value): &(&'static Number, f64)) -> bool {
    !(allowed.min..=allowed.max).contains(value)
}

fn sensor<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<usize, Error> {
    let name = words.next().ok_or(Error::Missing("sensor"))?;
    let known = SENSORS.iter().position(|known| *known == name);
    known.ok_or(Error::UnknownSensor(name.into()))
}

fn calibrate<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> Result<Request, Error> {
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

fn settings<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> Result<Request, Error> {
    if words.clone().next().is_none() {
        return Ok(Request::Settings(None));
    }
    Ok(Request::Settings(Some(whole(words, &LINE)?)))
}

fn set<'a>(words: &mut (impl Iterator<Item = &'a str> + Clone)) -> Result<Request, Error> {
    match words.next().ok_or(Error::Missing("setting"))? {
        "steps" => {
            let first = whole(words, &BORDER)?;
            let mut counts = heapless::Vec::new();
            while counts.is_empty() || words.clone().next().is_some() {
                if counts.len() == STEPS_A_LINE || first + counts.len() == FIRST_BORDER + BORDERS {
                    break;
                }
                let _ = counts.push(rounded(decimal(words, &STEP)?, Calibration::STEP_DECIMALS));
            }
            Ok(Request::SetSteps { first, counts })
        }
        "correction" => {
            let sensor = sensor(words)?;
            let mut values = [0.0; 3];
            for (value, expected) in values.iter_mut().zip(&CORRECTION) {
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
            let mut values = [0.0; TILE.len()];
            for (value, expected) in values.iter_mut().zip(&TILE) {
                *value = decimal(words, expected)?;
            }
            Ok(Request::SetTile(Tile::from_array(values)))
        }
        other => Err(Error::UnknownSetting(other.into())),
    }
}

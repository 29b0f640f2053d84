//! Parsing of the commands `calibrate`, `settings` and `set`.

use thermal_commissioning::{
    SENSOR_WORDS, SETTINGS_LINES, STEPS_PER_LINE, SessionRequest, Setting,
};
use thermal_settings::{
    BORDER_COUNT, CORRECTION_RANGES, Calibration, Correction, FIRST_BORDER, Range, STEP_RANGE,
    TILE_RANGES, Tile, round_to_decimals,
};

use crate::Error;
use crate::arguments::{Words, number, numbers, skip, whole_number, word};

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
    max: (FIRST_BORDER + BORDER_COUNT - 1) as f64,
};

/// Words of the settings that `set` replaces.
pub const SETTING_WORDS: [&str; 3] = ["steps", "correction", "tile"];

fn sensor(words: &mut Words<'_>) -> Result<usize, Error> {
    let name = word(words, "sensor")?;
    let known = SENSOR_WORDS.iter().position(|known| *known == name);
    known.ok_or(Error::UnknownSensor(name.into()))
}

/// Reads the arguments of `calibrate`.
pub fn calibrate(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    let sensor = sensor(words)?;
    if skip(words, "clear") {
        return Ok(SessionRequest::ClearCalibration { sensor });
    }
    Ok(SessionRequest::AddPoint {
        sensor,
        reference_c: number(words, &REFERENCE)?.to_num(),
    })
}

/// Reads the arguments of `settings`.
pub fn settings(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    if words.clone().next().is_none() {
        return Ok(SessionRequest::CountSettingsLines);
    }
    Ok(SessionRequest::SettingsLine(
        whole_number(words, &LINE)? - 1,
    ))
}

/// Reads the arguments of `set`.
#[inline(never)]
pub fn set(words: &mut Words<'_>) -> Result<Setting, Error> {
    Ok(match word(words, "setting")? {
        "steps" => {
            let first = whole_number(words, &BORDER)?;
            let room = STEPS_PER_LINE.min(FIRST_BORDER + BORDER_COUNT - first);
            let mut counts = heapless::Vec::new();
            // At least one step; a word too many is reported by the caller.
            while counts.is_empty() || counts.len() < room && words.clone().next().is_some() {
                let step = number(words, &STEP_RANGE)?.to_num();
                let _ = counts.push(round_to_decimals(step, Calibration::STEP_DECIMALS));
            }
            Setting::Steps { first, counts }
        }
        "correction" => {
            let sensor = sensor(words)?;
            let correction = Correction::from_array(numbers(words, &CORRECTION_RANGES)?);
            Setting::Correction(sensor, correction.rounded())
        }
        "tile" => Setting::Tile(Tile::from_array(numbers(words, &TILE_RANGES)?)),
        other => return Err(Error::UnknownSetting(other.into())),
    })
}

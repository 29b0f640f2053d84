//! Parsing of the commands `calibrate`, `settings` and `set`.

use thermal_commissioning::{
    CONVERTER_STEPS_PER_LINE_MAX, SETTINGS_LINE_COUNT, SessionRequest, Setting, THERMISTOR_WORDS,
};
use thermal_settings::{
    ADC_ERROR_STEP_RANGE, CALIBRATED_ADC_BORDER_COUNT, CORRECTION_RANGES, Calibration, Correction,
    FIRST_CALIBRATED_ADC_BORDER_INDEX, Range, TILE_RANGES, Tile, round_to_decimals,
};

use crate::Error;
use crate::arguments::{
    Words, read_fixed_point_in_range, read_numbers_in_ranges, read_whole_number_in_range,
    skip_if_next_is, word_or_empty,
};

static REFERENCE_TEMPERATURE_RANGE: Range = Range {
    name: "reference temperature",
    unit: "C",
    min: 0.0,
    max: 60.0,
};
static SETTINGS_LINE_NUMBER_RANGE: Range = Range {
    name: "line of settings",
    unit: "(whole)",
    min: 1.0,
    max: SETTINGS_LINE_COUNT as f64,
};
static ADC_SEGMENT_BORDER_INDEX_RANGE: Range = Range {
    name: "border",
    unit: "(whole)",
    min: FIRST_CALIBRATED_ADC_BORDER_INDEX as f64,
    max: (FIRST_CALIBRATED_ADC_BORDER_INDEX + CALIBRATED_ADC_BORDER_COUNT - 1) as f64,
};

/// First arguments of the command `set`, which name what it replaces: steps of the converter, the correction of a
/// thermistor, or the parameters of the tile.
pub const SET_COMMAND_TARGET_WORDS: [&str; 3] = ["steps", "correction", "tile"];

fn parse_thermistor_name_to_index(words: &mut Words<'_>) -> Result<usize, Error> {
    let name = word_or_empty(words);
    let known = THERMISTOR_WORDS.iter().position(|known| *known == name);
    known.ok_or(Error::UnknownSensor(name.into()))
}

/// Reads the arguments of the command `calibrate`: a thermistor, then either the temperature of the reference
/// thermometer, °C, which adds a calibration point, or `clear`, which removes the thermistor's calibration.
pub fn parse_calibration_point_or_clear(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    let sensor = parse_thermistor_name_to_index(words)?;
    if skip_if_next_is(words, "clear") {
        return Ok(SessionRequest::ClearCalibration { sensor });
    }
    Ok(SessionRequest::AddPoint {
        sensor,
        reference_c: read_fixed_point_in_range(words, &REFERENCE_TEMPERATURE_RANGE)?.to_num(),
    })
}

/// Reads the argument of the command `settings`: a number from 1 to 8 requests the line of the settings with this
/// number. Without an argument, the number of lines is requested.
pub fn parse_settings_query(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    if words.clone().next().is_none() {
        return Ok(SessionRequest::CountSettingsLines);
    }
    Ok(SessionRequest::SettingsLine(
        read_whole_number_in_range(words, &SETTINGS_LINE_NUMBER_RANGE)? - 1,
    ))
}

/// Reads the arguments of the command `set`, which replaces settings. They are `steps` with the index of a border
/// between two segments of the converter and one to seven steps, at this border and the next ones; or `correction` with
/// a thermistor and three coefficients; or `tile` with five parameters.
#[inline(never)]
pub fn parse_set_arguments(words: &mut Words<'_>) -> Result<Setting, Error> {
    Ok(match word_or_empty(words) {
        "steps" => {
            let first = read_whole_number_in_range(words, &ADC_SEGMENT_BORDER_INDEX_RANGE)?;
            let room = CONVERTER_STEPS_PER_LINE_MAX
                .min(FIRST_CALIBRATED_ADC_BORDER_INDEX + CALIBRATED_ADC_BORDER_COUNT - first);
            let mut counts = heapless::Vec::new();
            // At least one step. Words that follow the last possible step are left to the caller, who reports them.
            while counts.is_empty() || counts.len() < room && words.clone().next().is_some() {
                let step = read_fixed_point_in_range(words, &ADC_ERROR_STEP_RANGE)?.to_num();
                let _ = counts.push(round_to_decimals(
                    step,
                    Calibration::ADC_ERROR_STEP_DECIMALS,
                ));
            }
            Setting::Steps { first, counts }
        }
        "correction" => {
            let sensor = parse_thermistor_name_to_index(words)?;
            let correction =
                Correction::from_array(read_numbers_in_ranges(words, &CORRECTION_RANGES)?);
            Setting::Correction(sensor, correction.rounded())
        }
        "tile" => Setting::Tile(Tile::from_array_rounded(read_numbers_in_ranges(
            words,
            &TILE_RANGES,
        )?)),
        other => return Err(Error::UnknownSetting(other.into())),
    })
}

//! Parsing of the commands `calibrate`, `settings`, `set`, `flux` and `surface`.

use thermal_commissioning::{
    CONVERTER_STEPS_PER_LINE_MAX, SETTINGS_LINE_COUNT_MAX, SessionRequest, Setting,
    THERMISTOR_WORDS,
};
use thermal_settings::{
    ADC_ERROR_STEP_RANGE, CALIBRATED_ADC_BORDER_COUNT, CORRECTION_RANGES, Calibration, Correction,
    DISPLAY_SURFACE_RANGES, DisplaySurface, FIRST_CALIBRATED_ADC_BORDER_INDEX, FLUX_SENSOR_RANGES,
    FluxSensor, Range, TILE_RANGES, Tile, round_to_decimals,
};

use crate::Error;
use crate::arguments::{
    Words, read_number_in_range, read_numbers_in_ranges, read_whole_number_in_range,
    skip_if_next_is, word_or_empty,
};

static REFERENCE_TEMPERATURE_RANGE: Range =
    Range { name: "reference temperature", unit: "C", min: 0.0, max: 60.0 };
static SETTINGS_LINE_NUMBER_RANGE: Range = Range {
    name: "line of settings",
    unit: "(whole)",
    min: 1.0,
    max: SETTINGS_LINE_COUNT_MAX as f64,
};
static ADC_SEGMENT_BORDER_INDEX_RANGE: Range = Range {
    name: "border",
    unit: "(whole)",
    min: FIRST_CALIBRATED_ADC_BORDER_INDEX as f64,
    max: (FIRST_CALIBRATED_ADC_BORDER_INDEX + CALIBRATED_ADC_BORDER_COUNT - 1) as f64,
};

/// First arguments of the command `set`, which name what it replaces: steps of the converter, the correction of a
/// thermistor, the parameters of the tile, the heat-flux sensor, or the surface of the display.
pub const SET_COMMAND_TARGET_WORDS: [&str; 5] = ["steps", "correction", "tile", "flux", "surface"];

/// First arguments of the command `flux`, which without one is a query.
pub const FLUX_COMMAND_WORDS: [&str; 3] = ["set", "none", "zero"];

/// First arguments of the command `surface`, which without one is a query. The second one stands in `set surface`, too.
pub const SURFACE_COMMAND_WORDS: [&str; 2] = ["set", NOMINAL_SURFACE_WORD];
/// The surface of the reference design, in place of the three values of another one.
pub const NOMINAL_SURFACE_WORD: &str = "nominal";

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
        reference_c: read_number_in_range(words, &REFERENCE_TEMPERATURE_RANGE)?,
    })
}

/// Reads the argument of the command `settings`: a number from 1 to [`SETTINGS_LINE_COUNT_MAX`], 10, requests the line of the settings
/// with this number: there are 8, one more with a heat-flux sensor, and one more with a measured surface of the display. Without an argument, the number of lines is requested.
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
/// a thermistor and three coefficients; or `tile` with five parameters; or `flux` with the four values of a heat-flux sensor, or
/// `none`; or `surface` with the three values of the display's surface, or `nominal`.
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
                let step = read_number_in_range(words, &ADC_ERROR_STEP_RANGE)?;
                let _ = counts.push(round_to_decimals(step, Calibration::ADC_ERROR_STEP_DECIMALS));
            }
            Setting::Steps { first, counts }
        }
        "correction" => {
            let sensor = parse_thermistor_name_to_index(words)?;
            let correction =
                Correction::from_array(read_numbers_in_ranges(words, &CORRECTION_RANGES)?);
            Setting::Correction(sensor, correction.rounded())
        }
        "tile" => {
            Setting::Tile(Tile::from_array_rounded(read_numbers_in_ranges(words, &TILE_RANGES)?))
        }
        "flux" if skip_if_next_is(words, "none") => Setting::FluxSensor(None),
        "flux" => parse_flux_sensor(words)?,
        "surface" if skip_if_next_is(words, NOMINAL_SURFACE_WORD) => {
            Setting::DisplaySurface(DisplaySurface::NOMINAL)
        }
        "surface" => parse_display_surface(words)?,
        other => return Err(Error::UnknownSetting(other.into())),
    })
}

fn parse_flux_sensor(words: &mut Words<'_>) -> Result<Setting, Error> {
    let values = read_numbers_in_ranges(words, &FLUX_SENSOR_RANGES)?;
    let sensor = FluxSensor::from_array_rounded(values);
    Ok(Setting::FluxSensor(Some(sensor)))
}

/// Reads the arguments of the command `flux`: nothing for a query, `set` with the four values of a heat-flux sensor, `none`, or
/// `zero`.
pub fn parse_flux(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    Ok(match word_or_empty(words) {
        "" => SessionRequest::Flux,
        "set" => SessionRequest::Set(parse_flux_sensor(words)?),
        "none" => SessionRequest::Set(Setting::FluxSensor(None)),
        "zero" => SessionRequest::FluxZero,
        other => return Err(Error::UnknownFluxOrder(other.into())),
    })
}

fn parse_display_surface(words: &mut Words<'_>) -> Result<Setting, Error> {
    let values = read_numbers_in_ranges(words, &DISPLAY_SURFACE_RANGES)?;
    let surface = DisplaySurface::from_array_rounded(values);
    Ok(Setting::DisplaySurface(surface))
}

/// Reads the arguments of the command `surface`: nothing for a query, `set` with conductivity, roughness and slope of the display,
/// or `nominal`.
pub fn parse_surface(words: &mut Words<'_>) -> Result<SessionRequest, Error> {
    Ok(match word_or_empty(words) {
        "" => SessionRequest::DisplaySurface,
        "set" => SessionRequest::Set(parse_display_surface(words)?),
        NOMINAL_SURFACE_WORD => {
            SessionRequest::Set(Setting::DisplaySurface(DisplaySurface::NOMINAL))
        }
        other => return Err(Error::UnknownSurfaceOrder(other.into())),
    })
}

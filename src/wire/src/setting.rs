//! One line of a finger's settings.

use core::fmt;

use contact_model::decimal::Rounded;
use thermal_device::safety::ThermistorId;
use thermal_settings::{
    ADC_ERROR_STEP_RANGE, CALIBRATED_ADC_BORDER_COUNT, CORRECTION_RANGES, Calibration, Correction,
    DISPLAY_SURFACE_RANGES, DisplaySurface, FIRST_CALIBRATED_ADC_BORDER_INDEX, FLUX_SENSOR_RANGES,
    FluxSensor, TILE_RANGES, Tile, WordList, round_to_decimals,
};

use crate::ReadError;
use crate::argument::Argument;
#[cfg(feature = "host")]
use crate::host::ArgumentForm;
use crate::number::{Whole, quantities};
use crate::words::{
    Words, read_number_in_range, read_numbers_in_ranges, skip_if_next_is, word_or_empty,
};

/// Largest number of converter steps on one line of the settings. The converter has a calibrated step at each of 13
/// borders of its segments, so the steps take two lines.
pub const CONVERTER_STEPS_PER_LINE_MAX: usize = 7;
/// Number of lines of the settings that hold the converter's steps.
pub const CONVERTER_STEPS_LINES: usize =
    CALIBRATED_ADC_BORDER_COUNT.div_ceil(CONVERTER_STEPS_PER_LINE_MAX);
/// Number of lines that hold all commissioned settings of a finger without a heat-flux sensor whose display has the nominal
/// surface: the converter's steps, one for the correction of each thermistor, and one for the tile.
pub const SETTING_LINES_ALWAYS: usize = CONVERTER_STEPS_LINES + ThermistorId::ALL.len() + 1;
/// The same with one for a heat-flux sensor and one for the surface of the display.
pub const SETTING_LINES_MAX: usize = SETTING_LINES_ALWAYS + 2;
/// Stands for the surface of the reference design.
const NOMINAL_SURFACE_WORD: &str = "nominal";

quantities! {
    /// Index of a border between two segments of the converter.
    Border = "border", "(whole)", FIRST_CALIBRATED_ADC_BORDER_INDEX as f64,
        (FIRST_CALIBRATED_ADC_BORDER_INDEX + CALIBRATED_ADC_BORDER_COUNT - 1) as f64;
    /// Number of a line of the settings, from 1 on.
    SettingNumber = "line of settings", "(whole)", 1.0, SETTING_LINES_MAX as f64;
}

/// The part of a finger's settings that one line holds: a line that the host sends after `set`, or that the device
/// replies to `settings N`.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// `steps BORDER COUNTS...`: one to seven steps of the converter's error at successive borders of its segments,
    /// from the border `first` on. A step is the error just above a border minus that just below, converter counts.
    Steps {
        /// Index of the border to which the first element of `counts` belongs, 10 to 22; border `n` lies at the
        /// converter's code `128 n`.
        first: usize,
        /// Steps at the border `first` and at the borders after it, converter counts; positive if the code above the
        /// border is too high.
        counts: heapless::Vec<f64, CONVERTER_STEPS_PER_LINE_MAX>,
    },
    /// `correction SENSOR OFFSET SLOPE CURVATURE`: a thermistor, and the correction that is added to its temperature, with
    /// offset (K), slope (K/K) and curvature (1/K).
    Correction(ThermistorId, Correction),
    /// `tile GAIN JOULE LEAK LAG DEAD`: the tile's gain (cooling rate per ampere, K/s per A), Joule term (Joule heating
    /// relative to the cooling, 1/A), leak (rate at which a temperature deviation decays, 1/s), lag of the display's
    /// thermistor (s) and dead time (s).
    Tile(Tile),
    /// `flux GAIN ZERO LAG RESISTANCE`: the heat-flux sensor's gain (counts per W/m²), zero (counts), lag (ms) and thermal
    /// resistance (mm² K/W); `flux none` without one.
    FluxSensor(Option<FluxSensor>),
    /// `surface CONDUCTIVITY ROUGHNESS SLOPE`: the display's conductivity (W/mK), roughness (µm) and slope (rad); `surface nominal`
    /// for those of the reference design.
    DisplaySurface(DisplaySurface),
}

impl Argument for Setting {
    #[inline(never)]
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        const SETTINGS: &WordList = &WordList {
            kind: "setting",
            words: &["steps", "correction", "tile", "flux", "surface"],
        };
        Ok(match word_or_empty(words) {
            "steps" => {
                let first = Whole::<Border>::read(words)?.get();
                let room = CONVERTER_STEPS_PER_LINE_MAX
                    .min(FIRST_CALIBRATED_ADC_BORDER_INDEX + CALIBRATED_ADC_BORDER_COUNT - first);
                let mut counts = heapless::Vec::new();
                // At least one step. Words that follow the last possible step are left to the caller, who reports them.
                while counts.is_empty() || counts.len() < room && words.clone().next().is_some() {
                    let step = read_number_in_range(words, &ADC_ERROR_STEP_RANGE)?;
                    let _ =
                        counts.push(round_to_decimals(step, Calibration::ADC_ERROR_STEP_DECIMALS));
                }
                Self::Steps { first, counts }
            }
            "correction" => {
                let thermistor = ThermistorId::read(words)?;
                let values = read_numbers_in_ranges(words, &CORRECTION_RANGES)?;
                Self::Correction(thermistor, Correction::from_array(values).rounded())
            }
            "tile" => {
                Self::Tile(Tile::from_array_rounded(read_numbers_in_ranges(words, &TILE_RANGES)?))
            }
            "flux" if skip_if_next_is(words, "none") => Self::FluxSensor(None),
            "flux" => Self::FluxSensor(Some(FluxSensor::read(words)?)),
            "surface" if skip_if_next_is(words, NOMINAL_SURFACE_WORD) => {
                Self::DisplaySurface(DisplaySurface::NOMINAL)
            }
            "surface" => Self::DisplaySurface(DisplaySurface::read(words)?),
            unknown => return Err(ReadError::UnknownWord(SETTINGS, unknown.into())),
        })
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("a line of the settings")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steps { first, counts } => {
                write!(f, " steps {first}")?;
                let decimals = [Calibration::ADC_ERROR_STEP_DECIMALS; CONVERTER_STEPS_PER_LINE_MAX];
                write_numbers(f, counts, &decimals)
            }
            Self::Correction(thermistor, correction) => {
                f.write_str(" correction")?;
                thermistor.write(f)?;
                write_numbers(f, &correction.to_array(), &Calibration::CORRECTION_DECIMALS)
            }
            Self::Tile(tile) => {
                f.write_str(" tile")?;
                let values = tile.to_array();
                write_numbers(f, &values, &values.map(|_| Tile::DECIMALS))
            }
            Self::FluxSensor(None) => f.write_str(" flux none"),
            Self::FluxSensor(Some(sensor)) => {
                f.write_str(" flux")?;
                write_numbers(f, &sensor.to_array(), &FluxSensor::DECIMALS)
            }
            Self::DisplaySurface(DisplaySurface::NOMINAL) => {
                write!(f, " surface {NOMINAL_SURFACE_WORD}")
            }
            Self::DisplaySurface(surface) => {
                f.write_str(" surface")?;
                write_numbers(f, &surface.to_array(), &DisplaySurface::DECIMALS)
            }
        }
    }
}

/// Gain, zero, lag and thermal resistance.
impl Argument for FluxSensor {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        read_numbers_in_ranges(words, &FLUX_SENSOR_RANGES).map(Self::from_array_rounded)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Numbers(&FLUX_SENSOR_RANGES)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_array().iter().try_for_each(|value| write!(f, " {value}"))
    }
}

/// Conductivity, roughness and slope.
impl Argument for DisplaySurface {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        read_numbers_in_ranges(words, &DISPLAY_SURFACE_RANGES).map(Self::from_array_rounded)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Numbers(&DISPLAY_SURFACE_RANGES)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_array().iter().try_for_each(|value| write!(f, " {value}"))
    }
}

/// Writes each number after a space, with its number of decimals.
fn write_numbers(f: &mut fmt::Formatter<'_>, numbers: &[f64], decimals: &[i32]) -> fmt::Result {
    let mut numbers = numbers.iter().zip(decimals);
    numbers
        .try_for_each(|(number, decimals)| write!(f, " {}", Rounded(*number, *decimals as usize)))
}

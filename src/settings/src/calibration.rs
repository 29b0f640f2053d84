//! Calibration of the thermistors and of the analogue-to-digital converter.

/// Thermistor temperature at which the variable `u` of every [`Correction`] is 0: 29 °C, the middle of the range from
/// 15 to 43 °C in which thermistors are calibrated.
pub const CORRECTION_POLYNOMIAL_CENTER_C: f64 = 29.0;
/// Largest magnitude, K, of the variable `u` of a [`Correction`], the distance of the thermistor's temperature from 29
/// °C. Beyond 13 and 45 °C the correction keeps its value at these temperatures.
pub const CORRECTION_POLYNOMIAL_CLAMP_K: f64 = 16.0;

/// Width of one segment of the 12-bit analogue-to-digital converter: 128 of its 4096 codes. The converter's error is
/// constant within a segment, and has a step at the border to the next segment.
pub const CODES_PER_ADC_SEGMENT: u32 = 128;
/// Index of the first border between two segments of the analogue-to-digital converter at which the step of its error
/// is calibrated: 10. Border `n` lies at code `n * CODES_PER_ADC_SEGMENT`, so this border lies at code 1280,
/// which is 44 °C. Lower codes are warmer than any set-point of the display.
pub const FIRST_CALIBRATED_ADC_BORDER_INDEX: usize = 10;
/// Number of borders between segments of the analogue-to-digital converter at which the step of its error is
/// calibrated: the 13 borders at codes 1280 to 2816. With a 10 kΩ thermistor of 3950 K beta and a 10 kΩ pull-up
/// resistor these are 44 to 8 °C, which contains all set-points of the display (15 to 42 °C).
pub const CALIBRATED_ADC_BORDER_COUNT: usize = 13;

/// Calibration of one finger's temperature readings: the steps of the converter, and what its thermistors deviate from
/// the nominal ones in [`super::Settings`]. All zero before the first calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Step of the converter's error at each calibrated border between two segments, counts (of 4096); the first
    /// element is the step at [`FIRST_CALIBRATED_ADC_BORDER_INDEX`]. Positive if the codes above the border are too high compared
    /// with those below: the sum of the steps at all borders below a code, limited to ±8, is subtracted from that code,
    /// for every thermistor.
    pub steps_counts: [f64; CALIBRATED_ADC_BORDER_COUNT],
    /// Corrections that are added to the temperatures of the finger's five thermistors: display, second display, sink,
    /// skin, room.
    pub corrections: [Correction; 5],
}

/// Correction of one thermistor, K: `offset + slope u + curvature u^2` is added to its temperature `T`, °C, which is
/// computed with the nominal resistances; `u = T - 29 °C`, limited to ±16 K.
///
/// From 15 to 43 °C this polynomial follows the deviations of a thermistor and its pull-up resistor from their nominal
/// values, and the converter's errors of offset, gain and linearity, to better than 1 mK.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Constant term `offset` of the thermistor's correction, K: what is added at 29 °C.
    pub offset_k: f64,
    /// Coefficient `slope` of the thermistor's correction, K/K: what is added per kelvin above 29 °C.
    pub slope: f64,
    /// Coefficient `curvature` of the thermistor's correction, 1/K: what is added, K, per square of the distance from
    /// 29 °C, K².
    pub curvature_1_k: f64,
}

impl Calibration {
    /// Number of decimals, 3, of a step of the converter's error, counts, in a `set steps` line from the host and in
    /// the record in flash. Steps are rounded to it, so that line and record hold them exactly.
    pub const ADC_ERROR_STEP_DECIMALS: i32 = 3;
    /// Numbers of decimals of a correction's offset (K), slope (K/K) and curvature (1/K), in this order, in a
    /// `set correction` line from the host and in the record in flash.
    pub const CORRECTION_DECIMALS: [i32; 3] = [6, 7, 8];

    /// Returns this calibration with its steps rounded to [`Self::ADC_ERROR_STEP_DECIMALS`], and its corrections to
    /// [`Self::CORRECTION_DECIMALS`], as the record in flash holds them.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self {
            steps_counts: self
                .steps_counts
                .map(|step| round_to_decimals(step, Self::ADC_ERROR_STEP_DECIMALS)),
            corrections: self.corrections.map(|correction| correction.rounded()),
        }
    }
}

impl Correction {
    /// Offset (K), slope (K/K) and curvature (1/K), in the order in which a `set correction` line and the record in
    /// flash hold them.
    pub const fn to_array(&self) -> [f64; 3] {
        [self.offset_k, self.slope, self.curvature_1_k]
    }

    /// A correction with this offset (K), slope (K/K) and curvature (1/K); the inverse of [`Self::to_array`].
    pub const fn from_array([offset_k, slope, curvature_1_k]: [f64; 3]) -> Self {
        Self { offset_k, slope, curvature_1_k }
    }

    /// Returns this correction with offset, slope and curvature rounded to the 6, 7 and 8 decimals that the record in
    /// flash holds.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let [offset, slope, curvature] = Calibration::CORRECTION_DECIMALS;
        Self {
            offset_k: round_to_decimals(self.offset_k, offset),
            slope: round_to_decimals(self.slope, slope),
            curvature_1_k: round_to_decimals(self.curvature_1_k, curvature),
        }
    }
}

/// Rounds `value` to the nearest number with this many decimals, a half away from zero; the result is never -0.
pub fn round_to_decimals(value: f64, decimals: i32) -> f64 {
    let scale = power_of_ten(decimals);
    // Adding zero turns -0 into 0, which a line of text would otherwise write as "-0".
    libm::round(value * scale) / scale + 0.0
}

/// `10^exponent`, or 1 if `exponent` is negative. Multiplied by this power, a value with `exponent` decimals is a whole
/// number.
pub(crate) fn power_of_ten(exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |power, _| 10.0 * power)
}

//! Calibration of the thermistors and of the analogue-to-digital converter.

/// Centre of a [`Correction`]'s polynomial, °C.
pub const CORRECTION_CENTER_C: f64 = 29.0;
/// Half of the range over which a [`Correction`] is a polynomial, K; beyond it the correction is constant.
pub const CORRECTION_HALF_SPAN_K: f64 = 16.0;

/// Codes in one segment of the converter. Codes are evenly spaced within a segment; at the border to the next one the
/// characteristic has a step.
pub const SEGMENT_CODES: u32 = 128;
/// Index of the first border whose step is calibrated; border `n` lies at code `n * SEGMENT_CODES`.
pub const FIRST_BORDER: usize = 10;
/// Number of borders whose step is calibrated: codes 1280 to 2816, which are 44 to 9 °C of a 10 kΩ thermistor with a
/// beta of 3950 K under 10 kΩ.
pub const BORDER_COUNT: usize = 13;

/// Deviation of the readings from the nominal components in [`super::Settings`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Excess of the converter's code above a border over that below it, counts; the first is that of
    /// [`FIRST_BORDER`]. All sensors share the one converter.
    pub steps_counts: [f64; BORDER_COUNT],
    /// Corrections of the five thermistors: display, second display, sink, skin, room.
    pub corrections: [Correction; 5],
}

/// Correction of one thermistor: `offset + slope u + curvature u^2` is added to a reading `T`, where
/// `u = T - 29 °C`, limited to ±16 K.
///
/// From 15 to 43 °C this describes the tolerances of a thermistor and its divider and the offset, gain error and
/// nonlinearity of the converter to better than 1 mK.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Constant term, K.
    pub offset_k: f64,
    /// Linear term, K/K.
    pub slope: f64,
    /// Quadratic term, 1/K.
    pub curvature_1_k: f64,
}

impl Calibration {
    /// Decimals of a stored step. Values are rounded to their decimals, so that text and record hold them exactly.
    pub const STEP_DECIMALS: i32 = 3;
    /// Decimals of a stored correction: offset, slope, curvature.
    pub const CORRECTION_DECIMALS: [i32; 3] = [6, 7, 8];

    /// Rounds all values to the decimals that are stored.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self {
            steps_counts: self
                .steps_counts
                .map(|step| round_to_decimals(step, Self::STEP_DECIMALS)),
            corrections: self.corrections.map(|correction| correction.rounded()),
        }
    }
}

impl Correction {
    /// Offset, slope and curvature, in their order on a line of text.
    #[must_use]
    pub const fn to_array(&self) -> [f64; 3] {
        [self.offset_k, self.slope, self.curvature_1_k]
    }

    /// The inverse of [`Self::to_array`].
    #[must_use]
    pub const fn from_array([offset_k, slope, curvature_1_k]: [f64; 3]) -> Self {
        Self {
            offset_k,
            slope,
            curvature_1_k,
        }
    }

    /// Rounds all values to the decimals that are stored.
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

/// Rounds to a number of decimals.
#[must_use]
pub fn round_to_decimals(value: f64, decimals: i32) -> f64 {
    let scale = power_of_ten(decimals);
    // Adding zero turns -0 into 0, so that text cannot tell them apart.
    libm::round(value * scale) / scale + 0.0
}

/// `10^exponent` for an exponent that is not negative.
pub(crate) fn power_of_ten(exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |power, _| 10.0 * power)
}

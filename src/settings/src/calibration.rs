//! What calibration has found out about the thermistors and the converter.

/// Temperature about which [`Correction`] is a polynomial, °C.
pub const MIDDLE_C: f64 = 29.0;
/// A correction does not change any more this far from [`MIDDLE_C`], K.
pub const REACH_K: f64 = 16.0;

/// The converter's codes are even within equal segments of this many, and have a step from each to the next.
pub const SEGMENT_CODES: u32 = 128;
/// First border between segments whose step is known, as the number of segments below it.
pub const FIRST_BORDER: usize = 10;
/// Borders with a known step: codes 1280 to 2816, 9 to 44 °C of a 10 k thermistor of beta 3950 K under 10 k.
pub const BORDERS: usize = 13;

/// How readings differ from those of the class values in [`super::Settings`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// The one converter's steps, counts of what it reads too much above a border, from [`FIRST_BORDER`] on.
    pub steps_counts: [f64; BORDERS],
    /// The five thermistors' corrections: display, second display, sink, skin, room.
    pub corrections: [Correction; 5],
}

/// What is added to a reading `T` in °C: `offset + slope u + curvature u^2` with `u = T - 29 °C` within ±16 K.
///
/// A thermistor's tolerances, its divider's and the converter's offset, gain and bow are that to below a
/// millikelvin from 15 to 43 °C.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// K.
    pub offset_k: f64,
    /// K/K.
    pub slope: f64,
    /// 1/K.
    pub curvature_1_k: f64,
}

impl Calibration {
    /// Decimals that are kept, so that a line of text holds all of it.
    pub const STEP_DECIMALS: i32 = 3;
    /// Of a correction's offset, slope and curvature.
    pub const DECIMALS: [i32; 3] = [6, 7, 8];

    /// The same with the decimals that are kept.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self {
            steps_counts: self
                .steps_counts
                .map(|step| rounded(step, Self::STEP_DECIMALS)),
            corrections: self.corrections.map(|correction| correction.rounded()),
        }
    }
}

impl Correction {
    /// The same with the decimals that are kept.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let [offset, slope, curvature] = Calibration::DECIMALS;
        Self {
            offset_k: rounded(self.offset_k, offset),
            slope: rounded(self.slope, slope),
            curvature_1_k: rounded(self.curvature_1_k, curvature),
        }
    }
}

/// The nearest number of so many decimals.
#[must_use]
pub fn rounded(value: f64, decimals: i32) -> f64 {
    let mut scale = 1.0;
    for _ in 0..decimals {
        scale *= 10.0;
    }
    // Adding zero makes a negative one positive, which lines of text do not tell apart.
    libm::round(value * scale) / scale + 0.0
}

//! Calibration in fixed point: the converter's non-linearity and each thermistor's correction.

use contact_model::fixed_point::{Celsius, product};
use fixed::types::{I0F32, U28F4};

use super::{SCANS_PER_TICK, THERMISTORS};
use thermal_settings::{
    BORDER_COUNT, CORRECTION_CENTER_C, CORRECTION_HALF_SPAN_K, FIRST_BORDER, SEGMENT_CODES,
    Settings,
};

/// A sum of 16 conversions without the converter's error: 0 to 2^16, in sixteenths.
pub type CorrectedSum = U28F4;

/// Width of a segment of the converter's range in units of a sum, as a power of two: 128 codes.
const SEGMENT_SUMS_LOG2: u32 = (SEGMENT_CODES * SCANS_PER_TICK as u32).ilog2();
/// Number of segments of 128 codes in the converter's range.
const CONVERTER_SEGMENTS: usize = 1 << (u16::BITS - SEGMENT_SUMS_LOG2);
/// Width in units of a sum, as a power of two, over which noise spreads the converter's step at a border of two
/// segments: two codes on either side.
const BORDER_TRANSITION_LOG2: u32 = 6;
/// Half of that width, in units of a sum: how far below a border the transition begins.
const HALF_BORDER_TRANSITION: u32 = 1 << (BORDER_TRANSITION_LOG2 - 1);

/// Limit of the converter's error in any segment, counts. The host may set each step within its own range and all with
/// one sign; without this limit they could hide more than a kelvin from the fault detectors.
const CONVERTER_ERROR_MAX_COUNTS: f64 = 8.0;

/// Corrections of one finger's thermistor readings, without the thermistors' curve: the error of the converter, and for
/// each thermistor a polynomial correction and its self-heating. In fixed point, because a tick has no time for `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrationTables {
    /// Error of the analogue-to-digital converter, which all thermistors share.
    pub(super) converter: ConverterCorrection,
    /// Corrections of display, second display, sink, skin and room thermistor.
    pub(super) thermistors: [ThermistorCorrection; THERMISTORS],
}

impl CalibrationTables {
    /// Converts the calibration from `f64`, so it is for start-up and the task that serves the host, not for the tick.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let self_heating_k = &settings.self_heating_k;
        let corrections = &settings.calibration.corrections;
        Self {
            converter: ConverterCorrection::new(&settings.calibration.steps_counts),
            thermistors: core::array::from_fn(|i| {
                ThermistorCorrection::new(&corrections[i], self_heating_k[i])
            }),
        }
    }
}

/// Error of the analogue-to-digital converter, which is constant within each segment of 128 codes and has a step at
/// each border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ConverterCorrection {
    /// Reading minus true value in each segment, in sixteenths of the unit of a sum.
    errors: [i16; CONVERTER_SEGMENTS],
}

impl ConverterCorrection {
    /// Adds up the steps at the segments' borders, counts, into the error of each segment, limited to ±8 counts.
    fn new(steps_counts: &[f64; BORDER_COUNT]) -> Self {
        let units_per_count = libm::ldexp(SCANS_PER_TICK as f64, CorrectedSum::FRAC_NBITS as i32);
        let mut error = 0.0;
        Self {
            errors: core::array::from_fn(|segment| {
                if let Some(step) = segment
                    .checked_sub(FIRST_BORDER)
                    .and_then(|border| steps_counts.get(border))
                {
                    error += step;
                }
                let error = error.clamp(-CONVERTER_ERROR_MAX_COUNTS, CONVERTER_ERROR_MAX_COUNTS);
                libm::round(error * units_per_count) as i16
            }),
        }
    }

    /// A sum of 16 conversions without the converter's error, 0 to 2^16 - 1/16. Within two codes of a border the error
    /// is interpolated linearly, because noise spreads the conversions to both sides of the step and a sum does not
    /// tell on which side each one was.
    #[must_use]
    pub fn correct_sum(&self, sum: u16) -> CorrectedSum {
        let shifted = u32::from(sum) + HALF_BORDER_TRANSITION;
        let segment = (shifted >> SEGMENT_SUMS_LOG2) as usize;
        let from_transition = shifted & ((1 << SEGMENT_SUMS_LOG2) - 1);
        let error_in = |segment: usize| i32::from(self.errors[segment % CONVERTER_SEGMENTS]);
        let mut error = error_in(segment.min(CONVERTER_SEGMENTS - 1));
        if from_transition < 1 << BORDER_TRANSITION_LOG2 {
            let below = error_in(segment.saturating_sub(1));
            error = below + (((error - below) * from_transition as i32) >> BORDER_TRANSITION_LOG2);
        }
        let units = (u32::from(sum) << CorrectedSum::FRAC_NBITS).saturating_add_signed(-error);
        CorrectedSum::from_bits(units.min((1 << (u16::BITS + CorrectedSum::FRAC_NBITS)) - 1))
    }
}

/// What is added to the temperature of one thermistor, K: `offset + slope u + curvature u²`, with `u` its difference
/// from 29 °C, limited to ±16 K.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ThermistorCorrection {
    /// Constant term, K, less the thermistor's self-heating.
    offset: Celsius,
    /// Linear term, K/K.
    slope: I0F32,
    /// Quadratic term, 1/K.
    curvature: I0F32,
}

impl ThermistorCorrection {
    /// Temperature at which the polynomial's variable `u` is zero, 29 °C.
    const POLYNOMIAL_CENTRE: Celsius = Celsius::const_from_int(CORRECTION_CENTER_C as i32);
    /// Largest magnitude of the polynomial's variable `u`, 16 K; beyond it the correction is constant.
    const POLYNOMIAL_HALF_RANGE: Celsius = Celsius::const_from_int(CORRECTION_HALF_SPAN_K as i32);

    /// Converts the correction of one thermistor. Its self-heating, K, is subtracted, so that the reading is that of
    /// the surface and not of the warmer thermistor.
    fn new(correction: &thermal_settings::Correction, self_heating_k: f64) -> Self {
        let coefficient = |value| I0F32::from_bits(libm::ldexp(value, 32) as i32);
        Self {
            offset: Celsius::saturating_from_num(correction.offset_k - self_heating_k),
            slope: coefficient(correction.slope),
            curvature: coefficient(correction.curvature_1_k),
        }
    }

    /// The temperature, °C, after the correction. No product overflows: of their 64 bits, `slope u` uses 57 and
    /// `curvature u²` 61.
    #[must_use]
    pub fn corrected_temperature(&self, uncorrected: Celsius) -> Celsius {
        let u = uncorrected
            .saturating_sub(Self::POLYNOMIAL_CENTRE)
            .clamp(-Self::POLYNOMIAL_HALF_RANGE, Self::POLYNOMIAL_HALF_RANGE);
        let square: Celsius = product(u, u);
        let change = self.slope.wide_mul(u) + self.curvature.wide_mul(square);
        uncorrected
            .saturating_add(self.offset)
            .saturating_add(Celsius::wrapping_from_num(change))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The host may set each step to 4 counts; 13 of one sign would be 1.2 K at 43 °C.
    #[test]
    fn converter_correction_is_at_most_8_counts_whatever_the_steps() {
        for step in [-4.0, 4.0] {
            let correction = ConverterCorrection::new(&[step; BORDER_COUNT]);
            for sum in (0..=65_520).step_by(7) {
                let change = i64::from(correction.correct_sum(sum).to_bits())
                    - (i64::from(sum) << CorrectedSum::FRAC_NBITS);
                assert!(
                    change.abs() <= (8 * 16) << CorrectedSum::FRAC_NBITS,
                    "{change} sixteenths at {sum}"
                );
            }
        }
    }
}

//! Calibration in fixed point: the error of the analogue-to-digital converter, and the correction of each thermistor.

use contact_model::fixed_point::{Celsius, product, to_fixed, truncated_units};
use fixed::types::{I0F32, U28F4};

use super::{SCANS_PER_TICK, THERMISTOR_COUNT};
use thermal_settings::{
    CALIBRATED_ADC_BORDER_COUNT, CODES_PER_ADC_SEGMENT, CORRECTION_POLYNOMIAL_CENTER_C,
    CORRECTION_POLYNOMIAL_CLAMP_K, FIRST_CALIBRATED_ADC_BORDER_INDEX, Settings,
};

/// A sum of 16 conversions of 12 bits after subtraction of the converter's error: 0 to 65535.9375 in steps of 1/16.
pub type CorrectedSum = U28F4;

/// Width of one segment of the converter's range, as a power of two, in units of a sum of 16 conversions: 2^11, which
/// is 128 codes. Within a segment the converter's error is constant.
const ADC_SEGMENT_SUM_WIDTH_LOG2: u32 = (CODES_PER_ADC_SEGMENT * SCANS_PER_TICK as u32).ilog2();
/// Number of segments of 128 codes in the converter's range of 4096 codes: 32.
const ADC_SEGMENT_COUNT: usize = 1 << (u16::BITS - ADC_SEGMENT_SUM_WIDTH_LOG2);
/// Width of the transition at a border of two segments, as a power of two, in units of a sum of 16 conversions: 2^6,
/// which is two codes on either side of the border. Noise spreads conversions there over both segments, so the
/// converter's error is interpolated.
const BORDER_TRANSITION_SUM_WIDTH_LOG2: u32 = 6;
/// Half of the width of the transition at a border of two segments, in units of a sum of 16 conversions: how far below
/// the border the transition begins.
const BORDER_TRANSITION_SUM_HALF_WIDTH: u32 = 1 << (BORDER_TRANSITION_SUM_WIDTH_LOG2 - 1);

/// Largest magnitude of the converter's error in any segment, counts; a larger one is reduced to this. The host may set
/// each of the 13 steps between segments to ±4 counts; with equal signs they would add up to 52 counts, more than 1 K,
/// by which a hot display could hide from the fault detectors.
const ADC_SEGMENT_ERROR_CLAMP_COUNTS: f64 = 8.0;

/// Corrections of one finger's thermistor readings in fixed point: the error of the analogue-to-digital converter, and
/// for each thermistor a polynomial correction and its self-heating. The thermistors' resistance curve is not included.
/// Converted from the `f64` settings in advance, because a tick has no time for `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrationTables {
    /// Error of the analogue-to-digital converter, subtracted from the sums of all five thermistors, because one
    /// converter reads them all.
    pub(super) converter: AdcErrorTable,
    /// Corrections to be added to the temperatures of the five thermistors, in the order display, second display, sink,
    /// skin, room.
    pub(super) thermistors: [ThermistorCorrection; THERMISTOR_COUNT],
}

impl CalibrationTables {
    /// Converts calibration and self-heating from the settings. Computes in `f64`, so it is for start-up and for the
    /// task that serves the host, not for the control tick.
    pub fn new(settings: &Settings) -> Self {
        let self_heating_k = &settings.self_heating_k;
        let corrections = &settings.calibration.corrections;
        Self {
            converter: AdcErrorTable::new(&settings.calibration.steps_counts),
            thermistors: core::array::from_fn(|i| {
                ThermistorCorrection::new(&corrections[i], self_heating_k[i])
            }),
        }
    }
}

/// Error of the analogue-to-digital converter: its code minus the true value. It is subtracted from the sum of each
/// thermistor before the sum is converted to °C. It is constant within each segment of 128 codes, and has a calibrated
/// step at each of 13 borders between segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AdcErrorTable {
    /// The converter's code minus the true value in each segment, in 1/256 of a code (1/16 of a unit of a sum of 16
    /// conversions); at most ±8 codes.
    errors: [i16; ADC_SEGMENT_COUNT],
}

impl AdcErrorTable {
    /// Computes the converter's error in each segment from its steps at the borders of segments, in counts: adds them
    /// up from the lowest calibrated border upwards, and limits each sum to ±8 counts.
    fn new(steps_counts: &[f64; CALIBRATED_ADC_BORDER_COUNT]) -> Self {
        let units_per_count = libm::ldexp(SCANS_PER_TICK as f64, CorrectedSum::FRAC_NBITS as i32);
        let mut error = 0.0;
        Self {
            errors: core::array::from_fn(|segment| {
                if let Some(step) = segment
                    .checked_sub(FIRST_CALIBRATED_ADC_BORDER_INDEX)
                    .and_then(|border| steps_counts.get(border))
                {
                    error += step;
                }
                let error =
                    error.clamp(-ADC_SEGMENT_ERROR_CLAMP_COUNTS, ADC_SEGMENT_ERROR_CLAMP_COUNTS);
                libm::round(error * units_per_count) as i16
            }),
        }
    }

    /// Subtracts the converter's error from a sum of 16 conversions (0 to 65520); the result is 0 to 65535.9375. Within
    /// two codes of a border of two segments the error is interpolated linearly: noise spreads the conversions over
    /// both segments there, and the sum does not show how many were in each.
    pub fn correct_sum(&self, sum: u16) -> CorrectedSum {
        let shifted = u32::from(sum) + BORDER_TRANSITION_SUM_HALF_WIDTH;
        let segment = (shifted >> ADC_SEGMENT_SUM_WIDTH_LOG2) as usize;
        let from_transition = shifted & ((1 << ADC_SEGMENT_SUM_WIDTH_LOG2) - 1);
        let error_in = |segment: usize| i32::from(self.errors[segment % ADC_SEGMENT_COUNT]);
        let mut error = error_in(segment.min(ADC_SEGMENT_COUNT - 1));
        if from_transition < 1 << BORDER_TRANSITION_SUM_WIDTH_LOG2 {
            let below = error_in(segment.saturating_sub(1));
            error = below
                + (((error - below) * from_transition as i32) >> BORDER_TRANSITION_SUM_WIDTH_LOG2);
        }
        let units = (i32::from(sum) << CorrectedSum::FRAC_NBITS) - error;
        let largest = (1 << (u16::BITS + CorrectedSum::FRAC_NBITS)) - 1;
        CorrectedSum::from_bits(units.clamp(0, largest).unsigned_abs())
    }
}

/// Correction of one thermistor, K, which is added to its temperature: `offset + slope u + curvature u²`, where `u` is
/// the uncorrected temperature minus 29 °C, limited to ±16 K.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ThermistorCorrection {
    /// Constant term, K: the calibrated offset minus the thermistor's self-heating.
    offset: Celsius,
    /// Coefficient, K/K, of `u`, where `u` is the uncorrected temperature minus 29 °C, limited to ±16 K.
    slope: I0F32,
    /// Coefficient, 1/K, of `u²`, where `u` is the uncorrected temperature minus 29 °C, limited to ±16 K.
    curvature: I0F32,
}

impl ThermistorCorrection {
    /// Uncorrected temperature, 29 °C, at which the correction's variable `u` is zero: the middle of the polynomial's
    /// range of 13 to 45 °C.
    const POLYNOMIAL_CENTRE: Celsius =
        Celsius::const_from_int(CORRECTION_POLYNOMIAL_CENTER_C as i32);
    /// Largest magnitude of the correction's variable `u`, 16 K. Below 13 °C and above 45 °C the correction is
    /// constant.
    const POLYNOMIAL_HALF_RANGE: Celsius =
        Celsius::const_from_int(CORRECTION_POLYNOMIAL_CLAMP_K as i32);

    /// Converts the correction of one thermistor from `f64`. Subtracts `self_heating_k`, K, by which the thermistor is
    /// warmer than the surface that it is mounted on, so that the corrected reading is the temperature of the surface.
    #[inline(never)]
    fn new(correction: &thermal_settings::Correction, self_heating_k: f64) -> Self {
        let coefficient = |value| I0F32::from_bits(truncated_units(value, 32));
        Self {
            offset: to_fixed(correction.offset_k - self_heating_k),
            slope: coefficient(correction.slope),
            curvature: coefficient(correction.curvature_1_k),
        }
    }

    /// Adds the correction to a thermistor's uncorrected temperature; both are in °C. The products do not overflow
    /// their 64 bits: `slope u` uses 57 of them, `curvature u²` 61.
    pub fn corrected_temperature(&self, uncorrected: Celsius) -> Celsius {
        let u = uncorrected
            .saturating_sub(Self::POLYNOMIAL_CENTRE)
            .clamp(-Self::POLYNOMIAL_HALF_RANGE, Self::POLYNOMIAL_HALF_RANGE);
        let square: Celsius = product(u, u);
        let change = self.slope.wide_mul(u) + self.curvature.wide_mul(square);
        uncorrected.saturating_add(self.offset).saturating_add(Celsius::wrapping_from_num(change))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The host may set each step to ±4 counts; all 13 of one sign would add up to 52 counts, which are 1.2 K at 9 °C.
    #[test]
    fn converter_correction_is_at_most_8_counts_whatever_the_steps() {
        for step in [-4.0, 4.0] {
            let correction = AdcErrorTable::new(&[step; CALIBRATED_ADC_BORDER_COUNT]);
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

//! Calibration in integers: the converter's steps and each thermistor's polynomial.

use contact_model::fixed_point::Celsius;

use super::{SCANS_PER_TICK, THERMISTORS};
use thermal_settings::{BORDERS, FIRST_BORDER, MIDDLE_C, REACH_K, SEGMENT_CODES, Settings};

/// Binary places of a sum of conversions after its steps were taken out.
pub const FINE_BITS: u32 = 4;
/// Sums of one segment, as a power of two.
const SEGMENT_BITS: u32 = (SEGMENT_CODES * SCANS_PER_TICK as u32).ilog2();
const SEGMENTS: usize = 1 << (u16::BITS - SEGMENT_BITS);
/// Sums around a border over which noise spreads its step, as a power of two: four codes, two either way.
const BLUR_BITS: u32 = 6;
const HALF_BLUR: u32 = 1 << (BLUR_BITS - 1);

/// What a converter of this class is off by at most, counts. Single steps are within what lines may set and may all
/// have one sign; together they would hide more than a kelvin from the guard.
const OFF_COUNTS: f64 = 8.0;

/// A calibration, ready for the tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calibrated {
    /// Of the converter.
    pub steps: Steps,
    /// Of the thermistors.
    pub polynomials: [Polynomial; THERMISTORS],
}

impl Calibrated {
    /// `f64`, once.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let warmer_k = &settings.self_heating_k;
        let corrections = &settings.calibration.corrections;
        Self {
            steps: Steps::new(&settings.calibration.steps_counts),
            polynomials: core::array::from_fn(|i| Polynomial::new(&corrections[i], warmer_k[i])),
        }
    }
}

/// What the converter reads too much in each segment of its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// In sixteenths of a sum.
    too_much: [i16; SEGMENTS],
}

impl Steps {
    /// From the steps at its borders, counts; `f64`, once.
    #[must_use]
    pub fn new(steps_counts: &[f64; BORDERS]) -> Self {
        let per_count = libm::ldexp(SCANS_PER_TICK as f64, FINE_BITS as i32);
        let mut sum = 0.0;
        Self {
            too_much: core::array::from_fn(|segment| {
                if let Some(step) = segment
                    .checked_sub(FIRST_BORDER)
                    .and_then(|border| steps_counts.get(border))
                {
                    sum += step;
                }
                libm::round(sum.clamp(-OFF_COUNTS, OFF_COUNTS) * per_count) as i16
            }),
        }
    }

    /// The sum without them, in sixteenths, within what 16 bits of sum can be. Across a border they change along a line, over the codes into
    /// which noise spreads it: where in them the border lies, the device does not know.
    #[must_use]
    pub fn without(&self, sum: u16) -> u32 {
        let ahead = u32::from(sum) + HALF_BLUR;
        let segment = (ahead >> SEGMENT_BITS) as usize;
        let within = ahead & ((1 << SEGMENT_BITS) - 1);
        let of = |segment: usize| i32::from(self.too_much[segment % SEGMENTS]);
        let mut too_much = of(segment.min(SEGMENTS - 1));
        if within < 1 << BLUR_BITS {
            let before = of(segment.saturating_sub(1));
            too_much = before + (((too_much - before) * within as i32) >> BLUR_BITS);
        }
        (u32::from(sum) << FINE_BITS)
            .saturating_add_signed(-too_much)
            .min((1 << (u16::BITS + FINE_BITS)) - 1)
    }
}

/// What is added to a thermistor's temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polynomial {
    offset: Celsius,
    /// In 2^-32, per K.
    slope: i32,
    curvature: i32,
}

impl Polynomial {
    const MIDDLE: Celsius = Celsius::const_from_int(MIDDLE_C as i32);
    const REACH: Celsius = Celsius::const_from_int(REACH_K as i32);

    /// `f64`, once; what the thermistor warms itself, K, is taken away.
    #[must_use]
    pub fn new(correction: &thermal_settings::Correction, self_heating_k: f64) -> Self {
        Self {
            offset: Celsius::saturating_from_num(correction.offset_k - self_heating_k),
            slope: libm::ldexp(correction.slope, 32) as i32,
            curvature: libm::ldexp(correction.curvature_1_k, 32) as i32,
        }
    }

    /// The corrected temperature. No product overflows: `u` has 26 bits, its square in the same unit 30, slope and
    /// curvature 31.
    #[must_use]
    pub fn apply(&self, reached: Celsius) -> Celsius {
        let u = reached
            .saturating_sub(Self::MIDDLE)
            .clamp(-Self::REACH, Self::REACH)
            .to_bits();
        let times = |a: i32, b: i32| i64::from(a) * i64::from(b);
        let square = (times(u, u) >> Celsius::FRAC_NBITS) as i32;
        let change = (times(self.slope, u) + times(self.curvature, square)) >> 32;
        reached
            .saturating_add(self.offset)
            .saturating_add(Celsius::from_bits(change as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps that lines may set one by one, all of one sign: 13 times 4 counts would be 1.2 K at 43 °C.
    #[test]
    fn steps_together_move_a_reading_by_what_a_converter_can_be_off() {
        for step in [-4.0, 4.0] {
            let steps = Steps::new(&[step; BORDERS]);
            for sum in (0..=65_520).step_by(7) {
                let off = i64::from(steps.without(sum)) - (i64::from(sum) << FINE_BITS);
                assert!(
                    off.abs() <= (8 * 16) << FINE_BITS,
                    "{off} sixteenths at {sum}"
                );
            }
        }
    }
}

//! A first-order low-pass filter whose state never rounds its input away.

use contact_model::fixed_point::Celsius;
use fixed::types::{I0F32, I10F54};

use crate::TICK_HZ;

/// What one tick moves a filter by, as a part of the distance to its input; below one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coefficient(I0F32);

impl Coefficient {
    /// `1 - exp(-dt / time constant)`, exact for an input that is held during the tick. A time constant below 1.45 ticks
    /// counts as that. Computed in `f64`, for start-up.
    #[must_use]
    pub fn from_time_constant_s(time_constant_s: f64) -> Self {
        let part = 1.0 - libm::exp(-1.0 / (time_constant_s * f64::from(TICK_HZ)));
        Self(I0F32::from_bits(
            libm::ldexp(part.clamp(0.0, 0.499), 32) as i32
        ))
    }
}

/// Binary places of the filter's state below those of a temperature.
const EXTRA_STATE_PLACES: u32 = I10F54::FRAC_NBITS - Celsius::FRAC_NBITS;

/// A low-pass filter for a temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPass {
    coefficient: Coefficient,
    /// Output, K, with 32 binary places more than a temperature, so that no input is rounded away.
    state: I10F54,
}

impl LowPass {
    /// A filter with output zero.
    #[must_use]
    pub const fn new(coefficient: Coefficient) -> Self {
        Self {
            coefficient,
            state: I10F54::ZERO,
        }
    }

    /// Changes the coefficient; the output stays.
    pub const fn set_coefficient(&mut self, coefficient: Coefficient) {
        self.coefficient = coefficient;
    }

    /// The filter's output, °C or K as its input.
    #[must_use]
    pub const fn output(&self) -> Celsius {
        Celsius::from_bits((self.state.to_bits() >> EXTRA_STATE_PLACES) as i32)
    }

    /// Sets the filter's output, without a transient.
    pub fn set_output(&mut self, output: Celsius) {
        self.state = I10F54::from_bits(i64::from(output.to_bits()) << EXTRA_STATE_PLACES);
    }

    /// Filters the input of one tick. The output stays between its old value and the input, so nothing overflows; it moves
    /// by at most 512 K a time constant.
    pub fn filter(&mut self, input: Celsius) {
        let distance = input.saturating_sub(self.output());
        self.state += distance.wide_mul(self.coefficient.0);
    }
}

//! A first-order low-pass filter whose state never rounds its input away.

use contact_model::fixed_point::Celsius;
use fixed::types::{I0F32, I10F54};

use crate::TICK_HZ;

/// Coefficient of a first-order low-pass filter: the part of the distance to its input by which the output moves in one
/// tick of 1 ms. Below one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coefficient(I0F32);

impl Coefficient {
    /// The coefficient `1 - exp(-dt / time constant)`, which is exact for an input that is constant during the tick. A
    /// time constant below 1.45 ticks counts as 1.45 ticks. Computed in `f64`, so it is for start-up and not for the
    /// tick.
    #[must_use]
    pub fn from_time_constant_s(time_constant_s: f64) -> Self {
        let part = 1.0 - libm::exp(-1.0 / (time_constant_s * f64::from(TICK_HZ)));
        Self(I0F32::from_bits(
            libm::ldexp(part.clamp(0.0, 0.499), 32) as i32
        ))
    }
}

/// Binary places that the filter's state has beyond those of a [`Celsius`].
const EXTRA_STATE_PLACES: u32 = I10F54::FRAC_NBITS - Celsius::FRAC_NBITS;

/// A first-order low-pass filter for a temperature, °C, or a temperature difference, K, that takes one input per tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPass {
    coefficient: Coefficient,
    /// Output, °C or K, with 32 binary places more than a temperature, so that no change of the input is rounded away.
    state: I10F54,
}

impl LowPass {
    /// A filter whose output is 0 until its first input.
    #[must_use]
    pub const fn new(coefficient: Coefficient) -> Self {
        Self {
            coefficient,
            state: I10F54::ZERO,
        }
    }

    /// Changes the time constant by a new coefficient; the output stays.
    pub const fn set_coefficient(&mut self, coefficient: Coefficient) {
        self.coefficient = coefficient;
    }

    /// The filter's output after the last tick, in the unit of its input, °C or K.
    #[must_use]
    pub const fn output(&self) -> Celsius {
        Celsius::from_bits((self.state.to_bits() >> EXTRA_STATE_PLACES) as i32)
    }

    /// Sets the output to `output`, °C or K, as if this had been the input for long.
    pub fn set_output(&mut self, output: Celsius) {
        self.state = I10F54::from_bits(i64::from(output.to_bits()) << EXTRA_STATE_PLACES);
    }

    /// Moves the output by one tick towards `input`, °C or K. The output never passes the input, so nothing overflows.
    /// The distance saturates at 512 K.
    pub fn filter(&mut self, input: Celsius) {
        let distance = input.saturating_sub(self.output());
        self.state += distance.wide_mul(self.coefficient.0);
    }
}

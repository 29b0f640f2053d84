//! A first-order low-pass filter whose state is fine enough for the smallest change of the input.

use contact_model::fixed_point::{Celsius, truncated_units};
use fixed::types::{I0F32, I10F54};

use crate::TICK_HZ;

/// Coefficient of a first-order low-pass filter: the part of the distance between output and input by which the output
/// moves in one tick of 1 ms, 0 to 0.499.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coefficient(I0F32);

impl Coefficient {
    /// The coefficient `1 - exp(-1 ms / time constant)`, which is exact for an input that is constant during each tick.
    /// A time constant below 1.45 ms counts as 1.45 ms, for which the coefficient is 0.499. Computed in `f64`, so it is
    /// for start-up and the task that serves the host, not for the tick.
    pub fn from_time_constant_s(time_constant_s: f64) -> Self {
        let part = 1.0 - libm::exp(-1.0 / (time_constant_s * f64::from(TICK_HZ)));
        Self(I0F32::from_bits(truncated_units(part.clamp(0.0, 0.499), 32)))
    }
}

/// Binary places that the filter's state has in addition to the 22 of a [`Celsius`]: 32, as many as a [`Coefficient`]
/// has, so that even the smallest change of the input changes the state.
const EXTRA_STATE_BINARY_PLACES: u32 = I10F54::FRAC_NBITS - Celsius::FRAC_NBITS;

/// A first-order low-pass filter for a temperature, °C, or a temperature difference, K, with one input in each tick of
/// 1 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPass {
    coefficient: Coefficient,
    /// Output, °C or K, with 32 more binary places than a [`Celsius`], so that even the smallest change of the input
    /// changes the state.
    state: I10F54,
}

impl LowPass {
    /// A filter whose output is 0 (°C or K) until its first input.
    pub const fn new(coefficient: Coefficient) -> Self {
        Self { coefficient, state: I10F54::ZERO }
    }

    /// Changes the time constant of the filter to that of `coefficient`; the output stays.
    pub const fn set_coefficient(&mut self, coefficient: Coefficient) {
        self.coefficient = coefficient;
    }

    /// The filter's present output, in the unit of its input, °C or K.
    pub const fn output(&self) -> Celsius {
        Celsius::from_bits((self.state.to_bits() >> EXTRA_STATE_BINARY_PLACES) as i32)
    }

    /// Sets the output to `output`, °C or K, at once: the state after a long time with this input.
    pub fn set_output(&mut self, output: Celsius) {
        self.state = I10F54::from_bits(i64::from(output.to_bits()) << EXTRA_STATE_BINARY_PLACES);
    }

    /// Moves the output toward `input`, °C or K, by one tick: by their distance, saturated at ±512 K, times the
    /// coefficient. The output never passes the input, so no sum overflows.
    pub fn update_by_input(&mut self, input: Celsius) {
        let distance = input.saturating_sub(self.output());
        self.state += distance.wide_mul(self.coefficient.0);
    }
}

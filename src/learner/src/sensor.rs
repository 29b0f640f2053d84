//! The flux sensor.

use contact_model::fixed_point::to_fixed;
use fixed::types::{U0F32, U16F16};

use crate::window::{Resistance, WINDOW_S};

/// Shortest lag that is distinguished from none, s.
const LAG_MIN_S: f64 = 1e-4;

/// Properties of the flux sensor, as the learner needs them; in fixed point, because they pass the control path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FluxSensor {
    /// Part of the lag's state that remains at a window's end.
    remaining: U0F32,
    /// Mean over a window of what remains of the lag's state, 1 at the window's start.
    mean: U0F32,
    /// Prior deviation of the lag, over the lag: 0.1 plus 1 ms over the lag.
    lag_deviation: U16F16,
    resistance_mm2k_w: Resistance,
}

impl FluxSensor {
    /// Before the sensor is known.
    pub(crate) const UNKNOWN: Self = Self {
        remaining: U0F32::ZERO,
        mean: U0F32::ZERO,
        lag_deviation: U16F16::ONE,
        resistance_mm2k_w: Resistance::ZERO,
    };

    /// A sensor of this lag, µs (lags below 100 µs count as 100 µs), whose layer has this resistance. In `f64`, so for set-up
    /// only.
    pub fn new(lag_us: u32, resistance_mm2k_w: Resistance) -> Self {
        let lag_s = f64::from(lag_us) * 1e-6;
        let lag_s = if lag_s < LAG_MIN_S { LAG_MIN_S } else { lag_s };
        let windows = WINDOW_S / lag_s;
        let remaining = libm::exp(-windows);
        Self {
            remaining: to_fixed(remaining),
            mean: to_fixed((1.0 - remaining) / windows),
            lag_deviation: to_fixed(0.1 + 1e-3 / lag_s),
            resistance_mm2k_w,
        }
    }

    pub(crate) const fn remaining(&self) -> f32 {
        self.remaining.to_bits() as f32 / FRACTION_ONE as f32
    }

    pub(crate) const fn mean(&self) -> f32 {
        self.mean.to_bits() as f32 / FRACTION_ONE as f32
    }

    pub(crate) const fn lag_deviation(&self) -> f32 {
        self.lag_deviation.to_bits() as f32 / (1u32 << U16F16::FRAC_NBITS) as f32
    }

    /// Resistance, m² K/W.
    pub(crate) const fn resistance_m2k_w(&self) -> f32 {
        (self.resistance_mm2k_w.to_bits() as f32 / (1u32 << Resistance::FRAC_NBITS) as f32) * 1e-6
    }
}

const FRACTION_ONE: u64 = 1 << U0F32::FRAC_NBITS;

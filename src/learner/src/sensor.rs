//! The flux sensor.

use fixed::types::{U0F32, U16F16};

use crate::decay::WindowDecay;
use crate::window::{Resistance, WINDOW_S};

/// Shortest lag that is distinguished from none, s.
const LAG_MIN_S: f64 = 1e-4;

/// Properties of the flux sensor, as the learner needs them; in fixed point, because they pass the control path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FluxSensor {
    /// Part of the lag's state that remains at a window's end.
    remaining: U0F32,
    /// Mean of that part over the window.
    mean: U0F32,
    /// Prior deviation of the lag, relative: 10 % and 1 ms.
    lag_deviation: U16F16,
    resistance_mm2k_w: Resistance,
}

impl FluxSensor {
    /// A sensor of this lag, µs (lags below 100 µs count as 100 µs), whose layer has this resistance. In `f64`, so for set-up
    /// only.
    #[must_use]
    pub const fn new(lag_us: u32, resistance_mm2k_w: Resistance) -> Self {
        let mut lag_s = lag_us as f64 * 1e-6;
        if lag_s < LAG_MIN_S {
            lag_s = LAG_MIN_S;
        }
        let decay = WindowDecay::new(1.0 / lag_s);
        Self {
            remaining: fraction(decay.remaining),
            mean: fraction(decay.mean),
            lag_deviation: U16F16::from_bits(
                ((0.1 + 1e-3 / lag_s) * (1u32 << U16F16::FRAC_NBITS) as f64) as u32,
            ),
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

/// Saturates.
const fn fraction(value: f64) -> U0F32 {
    U0F32::from_bits((value * FRACTION_ONE as f64) as u32)
}

const _: () = assert!(1.0 / LAG_MIN_S * WINDOW_S < 1e4);

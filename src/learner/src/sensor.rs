//! The flux sensor.

use crate::decay::WindowDecay;
use crate::window::{Resistance, WINDOW_S};

/// Shortest lag that is distinguished from none, s.
const LAG_MIN_S: f64 = 1e-4;

/// Properties of the flux sensor, as the learner needs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxSensor {
    /// Part of the lag's state that remains at a window's end.
    pub(crate) remaining: f32,
    /// Mean of that part over the window.
    pub(crate) mean: f32,
    /// Prior deviation of the lag, relative: 10 % and 1 ms.
    pub(crate) lag_deviation: f32,
    /// Resistance, m² K/W.
    pub(crate) resistance_m2k_w: f32,
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
            remaining: decay.remaining as f32,
            mean: decay.mean as f32,
            lag_deviation: (0.1 + 1e-3 / lag_s) as f32,
            resistance_m2k_w: (resistance_mm2k_w.to_bits() as f64 * 1e-6
                / (1u32 << Resistance::FRAC_NBITS) as f64) as f32,
        }
    }
}

const _: () = assert!(1.0 / LAG_MIN_S * WINDOW_S < 1e4);

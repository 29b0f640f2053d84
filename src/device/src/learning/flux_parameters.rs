//! The heat-flux sensor's settings in fixed point.

use contact_model::fixed_point::to_fixed;
use contact_model::material::SKIN;
use fixed::types::{I28F4, U0F32, U8F24, U16F16};
use thermal_learner::{Flux, WINDOW_TICKS};
use thermal_settings::FluxSensor;

use crate::TICK_S;

/// How many lags of the sensor its flux counts after the window of the lifting: what is left of the contact's is then below 1 %.
const LAGS_AFTER_LIFTING: f64 = 5.0;

const WINDOW_MS: f64 = WINDOW_TICKS as f64 * 1e3 * TICK_S;

/// What ticks and learner need of the sensor's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxParameters {
    /// Code without flux.
    zero: I28F4,
    /// W/m² per count in each tick of a window, over the window's ticks.
    w_m2_per_summed_count: U8F24,
    /// Windows after that of the lifting in which the flux still counts.
    pub(super) windows_after_lifting: u32,
    /// Part of the distance to its input by which a low-pass filter of the sensor's lag moves in a window.
    pub(super) lag_coefficient: U0F32,
    /// The sensor for the learner.
    pub(super) sensor: thermal_learner::FluxSensor,
    /// Resistance of the layer: its temperature difference per kelvin of scaled flux.
    pub display_layer: U16F16,
}

impl FluxParameters {
    /// Converts from `f64`, for some microseconds, so it is for set-up and the host's task only.
    pub fn new(sensor: &FluxSensor) -> Self {
        let resistance_m2k_w = 1e-6 * sensor.resistance_mm2k_w;
        Self {
            zero: to_fixed(sensor.zero_counts),
            w_m2_per_summed_count: to_fixed(
                1.0 / (sensor.counts_per_w_m2 * f64::from(WINDOW_TICKS)),
            ),
            windows_after_lifting: (LAGS_AFTER_LIFTING * sensor.lag_ms / WINDOW_MS) as u32,
            lag_coefficient: to_fixed(WINDOW_MS / (WINDOW_MS + sensor.lag_ms)),
            sensor: thermal_learner::FluxSensor::new(
                (1e3 * sensor.lag_ms) as u32,
                to_fixed(sensor.resistance_mm2k_w),
            ),
            display_layer: to_fixed(resistance_m2k_w * SKIN.effusivity() / libm::sqrt(TICK_S)),
        }
    }

    /// Mean flux of a window whose codes have this sum.
    pub fn mean_flux(&self, codes: u32) -> Flux {
        let zeros = i64::from(self.zero.to_bits()) * i64::from(WINDOW_TICKS);
        let above_zeros = (i64::from(codes) << I28F4::FRAC_NBITS) - zeros;
        let bits = above_zeros * i64::from(self.w_m2_per_summed_count.to_bits());
        // From 4 + 24 binary places to 12. Settings have at most 100 W/m² per count of 4095, which fits.
        Flux::from_bits((bits >> (I28F4::FRAC_NBITS + U8F24::FRAC_NBITS - Flux::FRAC_NBITS)) as i32)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn mean_flux_is_the_mean_code_less_the_zero_over_the_gain(
            sum in 640..=40_310u32,
            zero in 1500.0..2500.0,
            gain in prop_oneof![Just(0.1192), 0.01..1.0],
        ) {
            let sensor = FluxSensor { counts_per_w_m2: gain, zero_counts: zero, ..FluxSensor::DESIGNED };
            let flux = FluxParameters::new(&sensor).mean_flux(sum);
            let exact = (f64::from(sum) / 10.0 - zero) / gain;
            // Rounded are the zero, to a sixteenth of a count, and the reciprocal of the gain.
            let error = 0.5 / f64::from(1 << I28F4::FRAC_NBITS) / gain + exact.abs() * 1e-6 + 1e-3;
            prop_assert!((flux.to_num::<f64>() - exact).abs() <= error, "{flux} for {exact}");
        }
    }
}

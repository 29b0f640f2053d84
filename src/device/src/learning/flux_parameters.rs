//! The heat-flux sensor's settings in fixed point.

use contact_model::fixed_point::to_fixed;
use contact_model::material::SKIN;
use fixed::types::{I28F4, U8F24, U16F16};
use thermal_learner::{Flux, WINDOW_TICKS};
use thermal_settings::FluxSensor;

use crate::TICK_S;

/// How many lags of the sensor its flux counts after the finger has lifted: what is left of the contact's is then below 1 %.
const LAGS_AFTER_LIFTING: f64 = 5.0;

/// What ticks and learner need of the sensor's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxParameters {
    /// Code without flux.
    zero: I28F4,
    /// W/m² per count in each tick of a window, over the window's ticks.
    w_m2_per_count_and_tick: U8F24,
    /// Ticks after lifting in which the flux still counts.
    pub(super) ticks_after_lifting: u32,
    /// The sensor for the learner.
    pub(super) sensor: thermal_learner::FluxSensor,
    /// Resistance of the layer: its temperature difference per kelvin of scaled flux.
    pub display_layer: U16F16,
}

impl FluxParameters {
    /// Converts from `f64`, for some microseconds, so it is for set-up and the host's task only.
    #[must_use]
    pub fn new(sensor: &FluxSensor) -> Self {
        let resistance_m2k_w = 1e-6 * sensor.resistance_mm2k_w;
        Self {
            zero: to_fixed(sensor.zero_counts),
            w_m2_per_count_and_tick: to_fixed(
                1.0 / (sensor.counts_per_w_m2 * f64::from(WINDOW_TICKS)),
            ),
            ticks_after_lifting: (LAGS_AFTER_LIFTING * sensor.lag_ms * 1e-3 / TICK_S) as u32,
            sensor: thermal_learner::FluxSensor::new(
                (1e3 * sensor.lag_ms) as u32,
                to_fixed(sensor.resistance_mm2k_w),
            ),
            display_layer: to_fixed(resistance_m2k_w * SKIN.effusivity() / libm::sqrt(TICK_S)),
        }
    }

    /// Mean flux of a window, if the codes of so many of its ticks have this sum and no flux is counted in the others.
    #[must_use]
    pub fn mean_flux(&self, codes: u32, ticks: u32) -> Flux {
        let zeros = i64::from(self.zero.to_bits()) * i64::from(ticks);
        let above_zeros = (i64::from(codes) << I28F4::FRAC_NBITS) - zeros;
        let bits = above_zeros * i64::from(self.w_m2_per_count_and_tick.to_bits());
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
        fn mean_flux_is_that_of_the_codes_less_the_zero_over_the_gain(
            codes in prop::collection::vec(64..4032u16, 0..=WINDOW_TICKS as usize),
            zero in 1500.0..2500.0,
            gain in prop_oneof![Just(0.1192), 0.01..1.0],
        ) {
            let sensor = FluxSensor { counts_per_w_m2: gain, zero_counts: zero, ..FluxSensor::DESIGNED };
            let sum = codes.iter().map(|code| u32::from(*code)).sum();
            let flux = FluxParameters::new(&sensor).mean_flux(sum, codes.len() as u32);
            let exact: f64 = codes.iter().map(|code| (f64::from(*code) - zero) / gain).sum::<f64>() / 10.0;
            // Rounded are the zero, to a sixteenth of a count, and the reciprocal of the gain.
            let error = 0.5 / f64::from(1 << I28F4::FRAC_NBITS) / gain + exact.abs() * 1e-6 + 1e-3;
            prop_assert!((flux.to_num::<f64>() - exact).abs() <= error, "{flux} for {exact}");
        }
    }
}

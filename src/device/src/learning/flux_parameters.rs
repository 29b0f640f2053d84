//! The heat-flux sensor's settings in fixed point.

use contact_model::fixed_point::to_fixed;
use contact_model::material::SKIN;
use fixed::types::{I20F12, I28F4, U16F16};
use thermal_settings::FluxSensor;

use crate::TICK_S;
use crate::low_pass::Coefficient;

/// How many lags of the sensor its flux counts after the finger has lifted: what is left of the contact's is then below 1 %.
const LAGS_AFTER_LIFTING: f64 = 5.0;

/// What ticks and learner need of the sensor's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxParameters {
    /// Code without flux.
    pub(super) zero: I28F4,
    /// W/m² per count.
    pub(super) w_m2_per_count: I20F12,
    /// Ticks after lifting in which the flux still counts.
    pub(super) ticks_after_lifting: u32,
    /// The sensor's lag.
    pub(super) lag: Coefficient,
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
            w_m2_per_count: to_fixed(1.0 / sensor.counts_per_w_m2),
            ticks_after_lifting: (LAGS_AFTER_LIFTING * sensor.lag_ms * 1e-3 / TICK_S) as u32,
            lag: Coefficient::from_time_constant_s(1e-3 * sensor.lag_ms),
            sensor: thermal_learner::FluxSensor::new(
                (1e3 * sensor.lag_ms) as u32,
                to_fixed(sensor.resistance_mm2k_w),
            ),
            display_layer: to_fixed(resistance_m2k_w * SKIN.effusivity() / libm::sqrt(TICK_S)),
        }
    }
}

//! The heat that the sensor measures beyond that of the modelled finger.
//!
//! The plate is cooled by the finger that is there. The model of the finger shows at once what is quicker than a window; the
//! sensor shows what the model has wrong, one to two windows later.

use contact_model::fixed_point::{contact_area, product, saturating_product};
use fixed::types::{I10F22, U0F32};
use thermal_learner::Flux;

use super::{FluxParameters, StateAtEnd};
use crate::estimate::Watt;

/// Ticks since landing from which on the differences count. Before, force and flux change too much in a window.
const FROM_TICKS: u64 = 30;
/// From W/m² to W/mm².
const M2_PER_MM2: U0F32 = U0F32::lit("1e-6");

/// Heat of the modelled finger behind the sensor's lag, and what was measured beyond it, W.
#[derive(Clone, Copy, Debug, Default)]
pub struct BeyondModel {
    modelled: Watt,
    heat: Watt,
}

impl BeyondModel {
    /// Takes the mean `flux` of a window, which is `None` if it cannot be right, and the mean heat of the model in the same ticks.
    pub fn end_window(
        &mut self,
        flux: Option<Flux>,
        modelled: Watt,
        parameters: &FluxParameters,
        state: &StateAtEnd,
    ) {
        let change = modelled.saturating_sub(self.modelled);
        let step: Watt = saturating_product(change, parameters.lag_coefficient);
        self.modelled = self.modelled.saturating_add(step);
        let is_known = state.ticks_since_landing >= FROM_TICKS;
        self.heat = flux.filter(|_| is_known).map_or(Watt::ZERO, |flux| {
            let flux_w_mm2: I10F22 = product(flux, M2_PER_MM2);
            let measured: Watt = saturating_product(flux_w_mm2, contact_area(state.force));
            measured.saturating_sub(self.modelled)
        });
    }

    /// Heat flow, W, beyond that of the model.
    #[must_use]
    pub const fn heat(&self) -> Watt {
        self.heat
    }
}

#[cfg(test)]
mod tests {
    use contact_model::fixed_point::Force;
    use thermal_settings::FluxSensor;

    use super::*;

    const STATE: StateAtEnd = StateAtEnd {
        skin: None,
        scaled_air_flux: contact_model::fixed_point::Celsius::ZERO,
        resistance: None,
        force: Force::lit("2"),
        ticks_since_landing: 30,
        is_steady: true,
    };

    fn parameters(lag_ms: f64) -> FluxParameters {
        FluxParameters::new(&FluxSensor {
            lag_ms,
            ..FluxSensor::DESIGNED
        })
    }

    /// A model whose heat rises by 0.5 W/s, and a sensor that sees 1.2 times as much, later by its lag.
    #[test]
    fn what_is_beyond_a_rising_heat_is_found_behind_any_lag() {
        let area_m2 = contact_model::pressure::contact_area_m2(2.0);
        for lag_ms in [1.0, 5.0, 20.0, 50.0] {
            let parameters = parameters(lag_ms);
            let mut beyond = BeyondModel::default();
            for window in 0..100 {
                let modelled_w = |at_s: f64| 0.5 * at_s;
                let at_s = 0.01 * f64::from(window);
                let measured_w = 1.2 * modelled_w(at_s - 1e-3 * lag_ms);
                let flux = Flux::from_num(measured_w / area_m2);
                beyond.end_window(
                    Some(flux),
                    Watt::from_num(modelled_w(at_s)),
                    &parameters,
                    &STATE,
                );
                if window >= 60 {
                    let exact_w = 0.2 * modelled_w(at_s - 1e-3 * lag_ms);
                    let apart_w = beyond.heat().to_num::<f64>() - exact_w;
                    assert!(apart_w.abs() < 1e-4, "{lag_ms} ms: {apart_w} of {exact_w}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_beyond_soon_after_a_landing_without_contact_and_without_a_flux() {
        let (mut beyond, parameters) = (BeyondModel::default(), parameters(5.0));
        let mut heat_w = |flux: Option<Flux>, ticks_since_landing| {
            let state = StateAtEnd {
                ticks_since_landing,
                ..STATE
            };
            beyond.end_window(flux, Watt::ZERO, &parameters, &state);
            beyond.heat().to_num::<f64>()
        };
        let flux = Some(Flux::lit("-5000"));
        for ticks in [0, 10, 29] {
            assert_eq!(heat_w(flux, ticks), 0.0);
        }
        let exact_w = -5000.0 * contact_model::pressure::contact_area_m2(2.0);
        assert!((heat_w(flux, 30) / exact_w - 1.0).abs() < 1e-4);
        assert_eq!(heat_w(None, 40), 0.0);
        assert!((heat_w(flux, 50) / exact_w - 1.0).abs() < 1e-4);
        assert_eq!(heat_w(flux, 0), 0.0);
    }
}

//! The flux that the sensor measures beyond that of the modelled finger.
//!
//! The plate loses heat to the real finger. The modelled flux is there in the same tick, but is that of the modelled finger; the measured
//! one comes one to two windows later. So the difference of the two is added to the modelled flux.

use contact_model::fixed_point::{product, saturating_product};
use fixed::types::U0F32;
use thermal_learner::Flux;

use super::{FluxParameters, StateAtEnd};
use crate::estimate::FluxPerMm2;

/// Ticks since landing from which on the difference is added to the model: from the first window that is all contact. What was
/// measured earlier is made up for then.
const ADDED_FROM_TICKS: u64 = 10;
/// From W/m² to W/mm².
const M2_PER_MM2: U0F32 = U0F32::lit("1e-6");

/// A measured flux in the model's unit.
pub fn flux_per_mm2(flux: Flux) -> FluxPerMm2 {
    product(flux, M2_PER_MM2)
}

/// Flux of the modelled finger behind the sensor's lag, and what is added to it in the present window.
#[derive(Clone, Copy, Debug, Default)]
pub struct BeyondModel {
    modelled: FluxPerMm2,
    added: FluxPerMm2,
    /// Sum over this contact's windows of the flux beyond the model less the flux that was added.
    deficit: FluxPerMm2,
}

impl BeyondModel {
    /// Takes the mean `flux` of a window, which is `None` if it cannot be right, and the mean flux of the model in the same ticks.
    ///
    /// The plate must get all the heat that was measured in the contact. So the next window also makes up for what was added too
    /// little before.
    pub fn end_window(
        &mut self,
        flux: Option<Flux>,
        modelled: FluxPerMm2,
        parameters: &FluxParameters,
        state: &StateAtEnd,
    ) {
        let change = modelled.saturating_sub(self.modelled);
        let step: FluxPerMm2 = saturating_product(change, parameters.lag_coefficient);
        self.modelled = self.modelled.saturating_add(step);
        let ticks = state.ticks_since_landing;
        let Some(flux) = flux.filter(|_| ticks > 0) else {
            (self.deficit, self.added) = (FluxPerMm2::ZERO, FluxPerMm2::ZERO);
            return;
        };
        let measured = flux_per_mm2(flux);
        let beyond = measured.saturating_sub(self.modelled);
        let short = beyond.saturating_sub(self.added);
        self.deficit = self.deficit.saturating_add(short);
        if ticks >= ADDED_FROM_TICKS {
            self.added = self.deficit.saturating_add(beyond);
        }
    }

    /// What is to be added to the flux of the model.
    pub const fn flux(&self) -> FluxPerMm2 {
        self.added
    }
}

#[cfg(test)]
mod tests {
    use thermal_settings::FluxSensor;

    use super::*;

    const STATE: StateAtEnd = StateAtEnd {
        skin: None,
        scaled_air_flux: contact_model::fixed_point::Celsius::ZERO,
        resistance: None,
        ticks_since_landing: ADDED_FROM_TICKS,
        is_steady: true,
        is_display_at_room: true,
    };

    fn parameters(lag_ms: f64) -> FluxParameters {
        FluxParameters::new(&FluxSensor { lag_ms, ..FluxSensor::DESIGNED })
    }

    fn w_m2(flux: FluxPerMm2) -> f64 {
        1e6 * flux.to_num::<f64>()
    }

    /// A model whose flux falls as after a landing, and a sensor that sees 1.5 times as much, later by its lag. At each window's end
    /// all the heat of the windows so far has been added, but for the change of the last one.
    #[test]
    fn all_the_heat_that_is_measured_is_added() {
        for lag_ms in [0.1, 5.0, 20.0] {
            let parameters = parameters(lag_ms);
            let mut beyond = BeyondModel::default();
            let coefficient = 10.0 / (10.0 + lag_ms);
            let (mut lagged, mut measured, mut added, mut before) = (0.0, 0.0, 0.0, 0.0);
            for window in 0..200 {
                let modelled = 10_000.0 / f64::from(1 + window).sqrt();
                lagged += coefficient * (modelled - lagged);
                let of_window = 0.5 * lagged;
                added += w_m2(beyond.flux());
                measured += of_window;
                let change = if window == 0 { of_window } else { of_window - before };
                let apart = measured - added - change;
                assert!(
                    apart.abs() < 2.0 * f64::from(1 + window),
                    "{lag_ms} ms, {window}: {apart}"
                );
                before = of_window;
                beyond.end_window(
                    Some(Flux::from_num(1.5 * lagged)),
                    FluxPerMm2::from_num(1e-6 * modelled),
                    &parameters,
                    &STATE,
                );
            }
        }
    }

    #[test]
    fn nothing_is_added_soon_after_a_landing_and_without_a_flux() {
        let (mut beyond, parameters) = (BeyondModel::default(), parameters(5.0));
        let mut added_w_m2 = |flux: Option<Flux>, ticks_since_landing| {
            let state = StateAtEnd { ticks_since_landing, ..STATE };
            beyond.end_window(flux, FluxPerMm2::ZERO, &parameters, &state);
            w_m2(beyond.flux())
        };
        let flux = Some(Flux::lit("-5000"));
        for ticks in [0, 9] {
            assert_eq!(added_w_m2(flux, ticks), 0.0);
        }
        // What was not added in the two windows before comes in the first one.
        assert!((added_w_m2(flux, 19) / -15_000.0 - 1.0).abs() < 1e-3);
        assert!((added_w_m2(flux, 29) / -5000.0 - 1.0).abs() < 1e-3);
        assert_eq!(added_w_m2(None, 39), 0.0);
        assert!((added_w_m2(flux, 49) / -10_000.0 - 1.0).abs() < 1e-3);
        assert_eq!(added_w_m2(flux, 0), 0.0);
    }
}

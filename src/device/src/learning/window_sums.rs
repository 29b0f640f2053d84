//! Sums over a window of ten ticks.

use contact_model::fixed_point::Celsius;
use fixed::types::{I10F22, I20F12, U16F16};
use thermal_learner::{Contact, Flux, Resistance, WINDOW_TICKS};

/// `e_skin / sqrt(dt)`, W/(K m²): a scaled flux, K, times this is a heat flux.
const W_M2_PER_SCALED_K: i64 = 36_999;
/// `sqrt(dt) / e_skin`, mm² K/W: a resistance, K per K of scaled flux, times this is a thermal resistance.
const MM2K_W_PER_SCALED: U16F16 = U16F16::lit("27.028");

/// A tick in which the finger presses on the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickOfContact {
    /// Skin before contact, as its thermistor has it, less the surface of the display, K.
    pub skin_above_display: Celsius,
    /// Whether the finger may be learnt from this tick: no jump of the force, and no limited set-point.
    pub is_steady: bool,
}

/// What is known at the end of a window with contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateAtEnd {
    /// Scaled flux that the air took from the assumed finger's skin before contact, K.
    pub scaled_air_flux: Celsius,
    /// Contact resistance of an average skin with the display at the mean force, K per K of scaled flux; `None` before the
    /// contact is detected.
    pub resistance: Option<U16F16>,
    /// Ticks since landing.
    pub ticks_since_landing: u64,
}

/// Sums over the ticks of the present window.
#[derive(Clone, Debug)]
pub struct WindowSums {
    ticks: u32,
    /// `None` once the flux of a tick was not valid.
    flux: Option<i64>,
    skin_above_display: i64,
    touching_ticks: u8,
    is_steady: bool,
}

impl Default for WindowSums {
    fn default() -> Self {
        Self {
            ticks: 0,
            flux: Some(0),
            skin_above_display: 0,
            touching_ticks: 0,
            is_steady: true,
        }
    }
}

impl WindowSums {
    /// Adds a tick: its flux, if it is valid, and the contact.
    pub fn add(&mut self, flux: Option<Flux>, contact: Option<TickOfContact>) {
        self.ticks += 1;
        let flux = flux.map(|flux| i64::from(flux.to_bits()));
        self.flux = self.flux.zip(flux).map(|(sum, flux)| sum + flux);
        if let Some(contact) = contact {
            self.skin_above_display += i64::from(contact.skin_above_display.to_bits());
            self.touching_ticks = self.touching_ticks.saturating_add(1);
            self.is_steady &= contact.is_steady;
        }
    }

    /// Whether all ticks were added.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.ticks >= WINDOW_TICKS
    }

    /// Mean flux; `None` if that of a tick was not valid.
    #[must_use]
    pub fn mean_flux(&self) -> Option<Flux> {
        // A mean of 32-bit numbers has 32 bits.
        let mean = self.flux? / i64::from(WINDOW_TICKS);
        Some(Flux::from_bits(mean as i32))
    }

    /// The contact of the window, if it had one.
    #[must_use]
    pub fn contact(&self, state: &StateAtEnd) -> Option<Contact> {
        if self.touching_ticks == 0 {
            return None;
        }
        let mean = self.skin_above_display / i64::from(WINDOW_TICKS);
        let air_bits = i64::from(state.scaled_air_flux.to_bits()) * W_M2_PER_SCALED_K;
        let air_bits = air_bits >> (I10F22::FRAC_NBITS - I20F12::FRAC_NBITS);
        let resistance = state.resistance.map_or(Resistance::ZERO, |scaled| {
            scaled.saturating_mul(MM2K_W_PER_SCALED)
        });
        Some(Contact {
            touching_ticks: self.touching_ticks,
            skin_above_display_k: Celsius::from_bits(mean as i32),
            air_flux_w_m2: Flux::from_bits(air_bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32),
            resistance_mm2k_w: resistance,
            ticks_since_landing: state.ticks_since_landing.min(u32::MAX.into()) as u32,
            is_steady: self.is_steady && state.resistance.is_some(),
        })
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use contact_model::fixed_point::OwnResistances;
    use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
    use contact_model::reference::contact_resistance;
    use proptest::prelude::*;

    use super::*;

    const STATE: StateAtEnd = StateAtEnd {
        scaled_air_flux: Celsius::ZERO,
        resistance: Some(U16F16::ONE),
        ticks_since_landing: 30,
    };

    fn tick() -> impl Strategy<Value = (Option<i32>, Option<(i32, bool)>)> {
        let contact = prop::option::of((any::<i32>(), prop::bool::weighted(0.9)));
        (prop::option::weighted(0.98, any::<i32>()), contact)
    }

    proptest! {
        #[test]
        fn means_are_those_of_the_ticks(ticks in prop::collection::vec(tick(), WINDOW_TICKS as usize)) {
            let mut sums = WindowSums::default();
            for (flux, contact) in &ticks {
                prop_assert!(!sums.is_complete());
                let contact = contact.map(|(above, is_steady)| TickOfContact {
                    skin_above_display: Celsius::from_bits(above),
                    is_steady,
                });
                sums.add(flux.map(Flux::from_bits), contact);
            }
            prop_assert!(sums.is_complete());
            let mean = |values: &[i32]| values.iter().map(|one| f64::from(*one)).sum::<f64>() / 10.0;
            let flux: Option<Vec<i32>> = ticks.iter().map(|tick| tick.0).collect();
            match (&flux, sums.mean_flux()) {
                (None, None) => {}
                (Some(flux), Some(found)) => {
                    prop_assert!((mean(flux) - f64::from(found.to_bits())).abs() <= 1.0);
                }
                (_, found) => prop_assert!(false, "{found:?}"),
            }
            let contacts: Vec<_> = ticks.iter().filter_map(|tick| tick.1).collect();
            let found = sums.contact(&STATE);
            prop_assert_eq!(found.is_some(), !contacts.is_empty());
            if let Some(found) = found {
                let above: Vec<_> = contacts.iter().map(|contact| contact.0).collect();
                let apart = mean(&above) - f64::from(found.skin_above_display_k.to_bits());
                prop_assert!(apart.abs() <= 1.0, "{}", apart);
                prop_assert_eq!(usize::from(found.touching_ticks), contacts.len());
                prop_assert_eq!(found.is_steady, contacts.iter().all(|contact| contact.1));
            }
        }
    }

    /// Against the resistance of Eq. 6-8 in m² K/W, and against the definition of the scaled flux.
    #[test]
    fn resistance_and_air_flux_are_in_units_of_the_learner() {
        let tick_s: f64 = 1e-3;
        let pair = contact_model::fixed_point::ContactPair::new(
            &SKIN,
            &MATERIALS[0].1,
            &REFERENCE_DISPLAY,
            tick_s,
        );
        let pressure_pa = contact_model::pressure::pressure_pa(2.0);
        let force = contact_model::fixed_point::Force::lit("2");
        let pressure = contact_model::fixed_point::log2_relative_pressure(force);
        let scaled = pair
            .expect("a pair")
            .at_pressure(pressure)
            .expected_display_resistance(&OwnResistances::NONE);
        let exact_m2k_w = contact_resistance(&SKIN.surface, &REFERENCE_DISPLAY, pressure_pa);
        let mut sums = WindowSums::default();
        let contact = TickOfContact {
            skin_above_display: Celsius::ONE,
            is_steady: true,
        };
        sums.add(None, Some(contact));
        let state = StateAtEnd {
            scaled_air_flux: Celsius::from_num(-0.003),
            resistance: Some(scaled),
            ..STATE
        };
        let found = sums.contact(&state).expect("a contact");
        let relative = found.resistance_mm2k_w.to_num::<f64>() / (1e6 * exact_m2k_w) - 1.0;
        assert!(relative.abs() < 1e-3, "{relative}");
        let air_w_m2 = -0.003 * SKIN.effusivity() / tick_s.sqrt();
        let apart = found.air_flux_w_m2.to_num::<f64>() - air_w_m2;
        assert!(apart.abs() < 1e-2, "{apart} of {air_w_m2}");
        let undetected = StateAtEnd {
            resistance: None,
            ..state
        };
        let found = sums.contact(&undetected).expect("a contact");
        assert!(!found.is_steady);
    }
}

//! Sums over a window of ten ticks.

use contact_model::fixed_point::Celsius;
use fixed::types::{I10F22, I20F12, U16F16};
use thermal_learner::{Contact, Flux, Resistance, WINDOW_TICKS};

/// `e_skin / sqrt(dt)`, W/(K m²): a scaled flux, K, times this is a heat flux.
const W_M2_PER_SCALED_K: i64 = 36_999;
/// `sqrt(dt) / e_skin`, mm² K/W: a resistance, K per K of scaled flux, times this is a thermal resistance.
const MM2K_W_PER_SCALED: U16F16 = U16F16::lit("27.028");

/// What is known at the end of a window with contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateAtEnd {
    /// Skin before contact, as its thermistor has it, °C; `None` without an estimate.
    pub skin: Option<Celsius>,
    /// Scaled flux that the air took from the assumed finger's skin before contact, K.
    pub scaled_air_flux: Celsius,
    /// Contact resistance of an average skin with the display at the mean force, K per K of scaled flux; `None` before the
    /// contact is detected.
    pub resistance: Option<U16F16>,
    /// Ticks since landing.
    pub ticks_since_landing: u64,
}

/// Sums of the sensor's codes.
#[derive(Clone, Copy, Debug, Default)]
pub struct CodeSums {
    /// Over the ticks in which the flux counts as none, and over the others.
    by_counting: [u32; 2],
    counting_ticks: u32,
    /// The bits in which a code differed from the one before.
    pub changed_bits: u16,
    /// Whether a tick had no code.
    pub is_one_missing: bool,
}

impl CodeSums {
    /// Adds the code of a tick, with the one before, and whether its flux counts.
    #[inline(always)]
    pub const fn add(&mut self, code: u16, before: u16, counts: bool) {
        self.by_counting[counts as usize] += code as u32;
        self.counting_ticks += counts as u32;
        self.changed_bits |= code ^ before;
    }

    /// Sum of all codes.
    #[must_use]
    pub const fn sum(&self) -> u32 {
        self.by_counting[0] + self.by_counting[1]
    }

    /// Sum of the codes whose flux counts, and their number.
    #[must_use]
    pub const fn counting(&self) -> (u32, u32) {
        (self.by_counting[1], self.counting_ticks)
    }
}

/// Sums over the ticks of the present window. They are all that a tick costs; what follows from them is found once a window.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowSums {
    ticks: u32,
    /// The sensor's codes.
    pub codes: CodeSums,
    /// Display's surface in the ticks in which the finger pressed.
    surface: i64,
    touching_ticks: u8,
    is_unsteady: bool,
}

impl WindowSums {
    /// Adds a tick. In one in which the finger presses: the surface of the display, °C, and whether the finger may be learnt from
    /// this tick: no jump of the force, and no limited set-point. Returns whether the window is complete.
    #[inline(always)]
    pub fn add(&mut self, contact: Option<(Celsius, bool)>) -> bool {
        self.ticks += 1;
        if let Some((surface, is_steady)) = contact {
            self.surface += i64::from(surface.to_bits());
            self.touching_ticks = self.touching_ticks.wrapping_add(1);
            self.is_unsteady |= !is_steady;
        }
        self.ticks >= WINDOW_TICKS
    }

    /// The contact of the window, if it had one.
    #[must_use]
    pub fn contact(&self, state: &StateAtEnd) -> Option<Contact> {
        if self.touching_ticks == 0 {
            return None;
        }
        let skin = i64::from(state.skin?.to_bits()) * i64::from(self.touching_ticks);
        // Ten differences of temperatures, less four bits, which are 4 uK: a division of 32 bits.
        const FEWER: u32 = 4;
        let sum = ((skin - self.surface) >> FEWER) as i32;
        let mean = sum / WINDOW_TICKS as i32 * (1 << FEWER);
        let air_bits = i64::from(state.scaled_air_flux.to_bits()) * W_M2_PER_SCALED_K;
        let air_bits = air_bits >> (I10F22::FRAC_NBITS - I20F12::FRAC_NBITS);
        let resistance = state.resistance.map_or(Resistance::ZERO, |scaled| {
            scaled.saturating_mul(MM2K_W_PER_SCALED)
        });
        Some(Contact {
            touching_ticks: self.touching_ticks,
            skin_above_display_k: Celsius::from_bits(mean),
            air_flux_w_m2: Flux::from_bits(air_bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32),
            resistance_mm2k_w: resistance,
            ticks_since_landing: state.ticks_since_landing.min(u32::MAX.into()) as u32,
            is_steady: !self.is_unsteady && state.resistance.is_some(),
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
        skin: Some(Celsius::ZERO),
        scaled_air_flux: Celsius::ZERO,
        resistance: Some(U16F16::ONE),
        ticks_since_landing: 30,
    };

    proptest! {
        #[test]
        fn means_are_those_of_the_ticks(
            skin_c in -20.0..60.0,
            ticks in prop::collection::vec(prop::option::of((-20.0..60.0, prop::bool::weighted(0.9))), WINDOW_TICKS as usize),
        ) {
            let mut sums = WindowSums::default();
            for (number, contact) in (1..).zip(&ticks) {
                let contact = contact.map(|(surface_c, is_steady)| (Celsius::from_num(surface_c), is_steady));
                prop_assert_eq!(sums.add(contact), number == WINDOW_TICKS);
            }
            let state = StateAtEnd { skin: Some(Celsius::from_num(skin_c)), ..STATE };
            let contacts: Vec<_> = ticks.iter().flatten().collect();
            let found = sums.contact(&state);
            prop_assert_eq!(found.is_some(), !contacts.is_empty());
            prop_assert_eq!(sums.contact(&StateAtEnd { skin: None, ..state }), None);
            if let Some(found) = found {
                let above_k = contacts.iter().map(|contact| skin_c - contact.0).sum::<f64>() / 10.0;
                let apart_k = above_k - found.skin_above_display_k.to_num::<f64>();
                prop_assert!(apart_k.abs() <= 5e-6, "{}", apart_k);
                prop_assert_eq!(usize::from(found.touching_ticks), contacts.len());
                prop_assert_eq!(found.is_steady, contacts.iter().all(|contact| contact.1));
            }
        }

        #[test]
        fn codes_are_added_by_whether_they_count(ticks in prop::collection::vec((0..4096u16, any::<bool>()), 10)) {
            let (mut sums, mut before) = (CodeSums::default(), ticks[0].0);
            for (code, counts) in &ticks {
                sums.add(*code, before, *counts);
                before = *code;
            }
            let counting = ticks.iter().filter(|tick| tick.1);
            let sum = |ticks: &mut dyn Iterator<Item = &(u16, bool)>| ticks.map(|tick| u32::from(tick.0)).sum::<u32>();
            prop_assert_eq!(sums.counting(), (sum(&mut counting.clone()), counting.count() as u32));
            prop_assert_eq!(sums.sum(), sum(&mut ticks.iter()));
            prop_assert_eq!(sums.changed_bits != 0, ticks.iter().any(|tick| tick.0 != ticks[0].0));
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
        sums.add(Some((Celsius::ONE, true)));
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

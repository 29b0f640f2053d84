//! Sums over a window of ten ticks.

use contact_model::fixed_point::Celsius;
use fixed::types::{I10F22, I20F12, U16F16};
use thermal_learner::{ContactInput, Flux, Resistance, WINDOW_TICKS};

use crate::estimate::FluxPerMm2;
use crate::sense::CONTACT_DEBOUNCE_TICKS;

/// `e_skin / sqrt(dt)`, W/(K m²): a scaled flux, K, times this is a heat flux.
const W_M2_PER_SCALED_K: i64 = 36_999;
/// `sqrt(dt) / e_skin`, mm² K/W: a resistance, K per K of scaled flux, times this is a thermal resistance.
const MM2K_W_PER_SCALED: U16F16 = U16F16::lit("27.028");

/// State at the end of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateAtEnd {
    /// Skin before contact, as its thermistor has it, °C; `None` without an estimate.
    pub skin: Option<Celsius>,
    /// Scaled flux that the air took from the assumed finger's skin before contact, K.
    pub scaled_air_flux: Celsius,
    /// Contact resistance of skin and display at the mean force by the finger's contact law, without the factor that is learnt and
    /// without the sensor's layer, K per K of scaled flux; `None` before the contact is detected.
    pub resistance: Option<U16F16>,
    /// Ticks since landing.
    pub ticks_since_landing: u64,
    /// Whether the finger may be learnt from this window: no jump of the force, and no limited set-point.
    pub is_steady: bool,
    /// Whether display and room are so near that hardly any heat flows through the sensor without a finger.
    pub is_display_at_room: bool,
}

/// What was measured in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeasuredTick {
    /// Code of the sensor.
    pub code: u16,
    /// Surface of the display, °C.
    pub surface: Celsius,
    /// Flux of the modelled finger.
    pub modelled_flux: FluxPerMm2,
    /// Whether the finger pressed in the ticks that end with this one.
    pub presses: bool,
}

/// Sums of code, surface and modelled flux over some ticks. Surfaces have a resolution of 4 uK.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    codes: u32,
    surface: i32,
    modelled_flux: FluxPerMm2,
}

/// Bits by which a surface temperature is shifted right before it is summed, so that a sum of ten fits into 32 bits.
const SURFACE_SHIFT: u32 = 4;

/// Sums over the ticks of the present window. They are all that a tick costs; what follows from them is found once a window.
///
/// It is known [`CONTACT_DEBOUNCE_TICKS`] ticks later whether the finger pressed in a tick: a force off zero counts when it has
/// lasted. So codes and surfaces are those of ten ticks that begin and end so much earlier.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowSums {
    ticks: u32,
    /// Over the ticks after those of `of_window`, which belong to the next window.
    of_next_window: Measured,
    /// Over the ten ticks of this window; they end [`CONTACT_DEBOUNCE_TICKS`] before it does.
    of_window: Measured,
    touching_ticks: u32,
    /// Whether a tick had no code.
    pub is_code_missing: bool,
}

impl WindowSums {
    /// Adds a tick. Returns whether the window is complete.
    #[inline(always)]
    pub fn add(&mut self, tick: &MeasuredTick) -> bool {
        self.of_next_window.codes += u32::from(tick.code);
        self.of_next_window.surface += tick.surface.to_bits() >> SURFACE_SHIFT;
        self.of_next_window.modelled_flux =
            (self.of_next_window.modelled_flux).saturating_add(tick.modelled_flux);
        self.touching_ticks += u32::from(tick.presses);
        self.ticks += 1;
        if self.ticks == WINDOW_TICKS - CONTACT_DEBOUNCE_TICKS {
            self.of_window = core::mem::take(&mut self.of_next_window);
        }
        self.ticks >= WINDOW_TICKS
    }

    /// Begins the next window. Its codes and surfaces replace those of this one before they are asked for.
    pub const fn begin_next(&mut self) {
        self.ticks = 0;
        self.touching_ticks = 0;
        self.is_code_missing = false;
    }

    /// Sum of the ten codes.
    pub const fn codes(&self) -> u32 {
        self.of_window.codes
    }

    /// Mean flux of the modelled finger in the ticks of the codes.
    pub const fn mean_modelled_flux(&self) -> FluxPerMm2 {
        FluxPerMm2::from_bits(self.of_window.modelled_flux.to_bits() / WINDOW_TICKS as i32)
    }

    /// Whether the finger pressed in a tick.
    pub const fn has_contact(&self) -> bool {
        self.touching_ticks != 0
    }

    /// The contact of the window, if it had one.
    pub fn contact(&self, state: &StateAtEnd) -> Option<ContactInput> {
        if !self.has_contact() {
            return None;
        }
        // In the window of a landing the surface before it counts, too, which is nearly the same.
        let surface = self.of_window.surface / WINDOW_TICKS as i32 * (1 << SURFACE_SHIFT);
        let above = state.skin?.saturating_sub(Celsius::from_bits(surface));
        let of_tick = Celsius::from_bits(above.to_bits() / WINDOW_TICKS as i32);
        let air_bits = i64::from(state.scaled_air_flux.to_bits()) * W_M2_PER_SCALED_K;
        let air_bits = air_bits >> (I10F22::FRAC_NBITS - I20F12::FRAC_NBITS);
        let resistance = state
            .resistance
            .map_or(Resistance::ZERO, |scaled| scaled.saturating_mul(MM2K_W_PER_SCALED));
        Some(ContactInput {
            touching_ticks: self.touching_ticks as u8,
            skin_above_display_k: of_tick.saturating_mul_int(self.touching_ticks as i32),
            air_flux_w_m2: Flux::from_bits(air_bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32),
            resistance_mm2k_w: resistance,
            ticks_since_landing: state.ticks_since_landing.min(u32::MAX.into()) as u32,
            is_steady: state.is_steady && state.resistance.is_some(),
        })
    }
}

#[cfg(test)]
mod tests {
    use contact_model::fixed_point::OwnResistances;
    use contact_model::material::{REFERENCE_DISPLAY, SKIN, find};
    use contact_model::reference::contact_resistance;
    use proptest::prelude::*;

    use super::*;

    const STATE: StateAtEnd = StateAtEnd {
        skin: Some(Celsius::ZERO),
        scaled_air_flux: Celsius::ZERO,
        resistance: Some(U16F16::ONE),
        ticks_since_landing: 30,
        is_steady: true,
        is_display_at_room: true,
    };

    fn tick() -> impl Strategy<Value = MeasuredTick> {
        let values = (0..4096u16, -20.0..60.0, -8.0..8.0, any::<bool>());
        values.prop_map(|(code, surface_c, flux_w_mm2, presses)| MeasuredTick {
            code,
            surface: Celsius::from_num(surface_c),
            modelled_flux: FluxPerMm2::from_num(flux_w_mm2),
            presses,
        })
    }

    proptest! {
        /// Code, surface and flux are those of two ticks earlier.
        #[test]
        fn sums_are_those_of_the_ticks(skin_c in -20.0..60.0, ticks in prop::collection::vec(tick(), 50)) {
            let mut sums = WindowSums::default();
            for (number, tick) in ticks.iter().enumerate() {
                let is_complete = sums.add(tick);
                prop_assert_eq!(is_complete, number % 10 == 9);
                if !is_complete {
                    continue;
                }
                let measured = &ticks[(number - 9).saturating_sub(2)..number - 1];
                let codes: u32 = measured.iter().map(|tick| u32::from(tick.code)).sum();
                prop_assert_eq!(sums.codes(), codes);
                let flux_w_mm2 = measured.iter().map(|tick| tick.modelled_flux.to_num::<f64>()).sum::<f64>() / 10.0;
                let apart = flux_w_mm2 - sums.mean_modelled_flux().to_num::<f64>();
                prop_assert!(apart.abs() <= 2.4e-7, "{}", apart);
                let pressed = ticks[number - 9..=number].iter().filter(|tick| tick.presses).count();
                let state = StateAtEnd { skin: Some(Celsius::from_num(skin_c)), ..STATE };
                let found = sums.contact(&state);
                prop_assert_eq!(found.is_some(), pressed > 0);
                prop_assert_eq!(sums.contact(&StateAtEnd { skin: None, ..state }), None);
                if let Some(found) = found {
                    prop_assert_eq!(usize::from(found.touching_ticks), pressed);
                    prop_assert!(found.is_steady);
                    let unsteady = StateAtEnd { is_steady: false, ..state };
                    prop_assert!(sums.contact(&unsteady).is_some_and(|contact| !contact.is_steady));
                    let surface_c = measured.iter().map(|tick| tick.surface.to_num::<f64>()).sum::<f64>() / 10.0;
                    let above_k: f64 = (skin_c - surface_c) * pressed as f64 / 10.0;
                    let apart_k = above_k - found.skin_above_display_k.to_num::<f64>();
                    prop_assert!(apart_k.abs() <= 1e-5, "{}", apart_k);
                }
                sums.begin_next();
            }
        }
    }

    /// Against the resistance of Eq. 6-8 in m² K/W, and against the definition of the scaled flux.
    #[test]
    fn resistance_and_air_flux_are_in_units_of_the_learner() {
        let tick_s: f64 = 1e-3;
        let pair = contact_model::fixed_point::ContactPair::new(
            &SKIN,
            find("copper").expect("copper"),
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
        let tick = MeasuredTick {
            code: 0,
            surface: Celsius::ONE,
            modelled_flux: FluxPerMm2::ZERO,
            presses: true,
        };
        sums.add(&tick);
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
        let undetected = StateAtEnd { resistance: None, ..state };
        let found = sums.contact(&undetected).expect("a contact");
        assert!(!found.is_steady);
    }
}

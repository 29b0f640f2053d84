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
    flux: i64,
    skin_above_display: i64,
    touching_ticks: u8,
    is_steady: bool,
}

impl Default for WindowSums {
    fn default() -> Self {
        Self {
            ticks: 0,
            flux: 0,
            skin_above_display: 0,
            touching_ticks: 0,
            is_steady: true,
        }
    }
}

impl WindowSums {
    /// Adds a tick: its flux, if it counts; the contact; whether the sensor's code is valid.
    pub fn add(&mut self, flux: Option<Flux>, contact: Option<TickOfContact>, is_valid: bool) {
        self.ticks += 1;
        self.flux += i64::from(flux.unwrap_or(Flux::ZERO).to_bits());
        self.is_steady &= is_valid;
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

    /// Mean flux.
    #[must_use]
    pub const fn mean_flux(&self) -> Flux {
        // A mean of 32-bit numbers has 32 bits.
        Flux::from_bits((self.flux / WINDOW_TICKS as i64) as i32)
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

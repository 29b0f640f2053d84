//! Simulation of the skin on the presented object, from the heat that would flow into the object at the measured force.
//!
//! With the law `model`, the set-point follows from the simulated skin where the closed form of Eq. 6-12 does not hold:
//! under a changing force, and in a contact that begins soon after another one.

use contact_model::fixed_point::{
    Body, BodyState, Celsius, ContactConductance, ContactPair, Force, Fraction, OwnResistances,
    Ratio, TissueStateFactors, Word, log2_relative_pressure, saturating_product,
};
use fixed::types::U16F16;

use crate::estimate::{Bodies, SkinState, flux_beyond_air};

/// Constants of Eq. 6-12 for the contacts of a finger with one object and with the display. The default, before any
/// object, is zero throughout; no heat flows with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactPairFactors {
    /// Fraction of the difference between skin and object temperature by which the skin's surface cools in a long
    /// contact: `e_object / (e_object + e_skin)`, with the thermal effusivities `e`.
    pub weight: Fraction,
    /// Reciprocal of `weight`, `(e_object + e_skin) / e_object`. The cooling of the skin's surface times this factor is
    /// the decrease of the temperature difference between skin and object surface, because the object's surface warms
    /// at the same time.
    inverse_weight: U16F16,
    /// Contact resistance of skin to display divided by that of skin to object, `R_display / R_object`. The temperature
    /// drop across the object's contact times this ratio is the drop that the same heat flow causes across the
    /// display's contact.
    ratio: Ratio,
    /// The same with the finger's own resistances at the force with which a finger is expected to land, for the time before
    /// contact: a layer on the display makes it depend on the force.
    pub ratio_at_landing: Ratio,
}

/// Force with which a finger is expected to land, N.
const LANDING_FORCE: Force = Force::lit("1");

impl ContactPairFactors {
    /// Computes the constants of Eq. 6-12 for the contacts of the skin with object and display in `pair`: the weight of
    /// the object, its reciprocal, and the ratio of the contact resistances. The reciprocal takes a 64-bit division, for
    /// which the processor has no instruction, so it is computed only when another object is presented.
    pub fn new(pair: &ContactPair, resistances: &OwnResistances) -> Self {
        // With a gap the set-point begins near the object's temperature, and has left it after some milliseconds: a display that
        // waited there would be late for all that follows.
        let without_law = OwnResistances { law: None, ..*resistances };
        // 1 in 2^-48 over the weight in 2^-32.
        let inverse = (1u64 << 48) / u64::from(pair.weight().to_bits().max(1));
        Self {
            weight: pair.weight(),
            inverse_weight: U16F16::from_bits(inverse.min(u64::from(u32::MAX)) as u32),
            ratio: pair.ratio(),
            ratio_at_landing: pair
                .at_pressure(log2_relative_pressure(LANDING_FORCE))
                .ratio_of(&without_law),
        }
    }

    /// Whether these factors hold for `pair`, so that they need not be computed again: its weight and its ratio are
    /// equal to theirs.
    pub fn were_computed_for(&self, pair: &ContactPair) -> bool {
        self.weight == pair.weight() && self.ratio == pair.ratio()
    }
}

/// Finger and object that are not both half-spaces, before the contact.
#[derive(Clone, Copy, Debug)]
pub struct BodiesBeforeContact<'a> {
    /// Finger and object.
    pub bodies: &'a Bodies,
    /// The skin's temperature minus the object's, K.
    pub skin_above_object: Celsius,
    /// The skin's temperature minus the room's, K.
    pub skin_above_room: Celsius,
}

/// Changes of the surfaces' temperatures since before the contact, K.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceChanges {
    /// How much colder the skin's surface is.
    pub cooling: Celsius,
    /// How much warmer the object's surface is.
    pub warming: Celsius,
}

impl SurfaceChanges {
    /// The set-point, °C, as [`SkinOnObject::setpoint`], for a ratio of the resistances of display and object.
    #[inline]
    pub fn setpoint(
        &self,
        ratio: Ratio,
        skin_before_contact: Celsius,
        skin_above_object: Celsius,
    ) -> Celsius {
        let step_at_object =
            skin_above_object.saturating_sub(self.cooling).saturating_sub(self.warming);
        let step_at_display: Celsius = saturating_product(step_at_object, ratio);
        skin_before_contact.saturating_sub(self.cooling).saturating_sub(step_at_display)
    }
}

/// Simulates, tick by tick, how the finger's skin would cool or warm if it touched the presented object instead of the
/// display, under the measured force.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SkinOnObject {
    /// Thermal state of the simulated skin. Its output is the decrease of the skin's surface temperature since before
    /// contact, K; negative if the object has warmed the skin. It decays towards zero while no finger touches.
    skin: SkinState,
    /// Warming of the object's surface by the simulated heat, K; not used while both are half-spaces.
    object: BodyState,
    /// Heat flux of this tick from the simulated skin into the object, positive out of the skin. It is counted as `q
    /// sqrt(dt) / e_skin`, K, with the flux `q`, the tick `dt` and the skin's effusivity `e_skin`.
    scaled_flux: Celsius,
}

impl SkinOnObject {
    /// Makes the simulated skin start a new contact with the presented object: it starts with the cooling that the
    /// display has caused in the real skin, `skin_state_on_display`, and without heat flux. An object that is no
    /// half-space starts at its temperature before contact.
    pub fn start_from_skin_on_display(
        &mut self,
        skin_state_on_display: &SkinState,
        bodies: &Bodies,
    ) {
        self.skin = skin_state_on_display.staggered(bodies);
        self.object = BodyState::default();
        self.scaled_flux = Celsius::ZERO;
    }

    /// Makes the simulated skin's state that which the heat so far would have made in the tissue `to`.
    pub fn change_tissue(&mut self, factors: &TissueStateFactors, to: &Body) {
        self.skin.change_tissue(factors, to);
    }

    /// Advances the simulated skin by one tick of 1 ms, for two half-spaces. `conductance` is that of the contact of skin
    /// and object. It is `None` while no finger touches; then no heat flows, and the cooling of the skin decays towards
    /// zero. `skin_above_object` is the skin's temperature minus the object's, both before contact, K.
    #[inline(always)]
    pub fn step(
        &mut self,
        conductance: Option<&ContactConductance>,
        factors: &ContactPairFactors,
        skin_above_object: Celsius,
    ) {
        if let Some(state) = self.skin.half_space() {
            self.scaled_flux = conductance.map_or(Celsius::ZERO, |conductance| {
                let without_resistance = saturating_product(skin_above_object, factors.weight);
                conductance.scaled_flux(without_resistance, state)
            });
            state.step(self.scaled_flux);
        }
    }

    /// As [`Self::step`], for bodies that are not both half-spaces. The object exchanges no heat before contact, the skin
    /// with the room. Returns cooling and warming of the two surfaces in the coming tick, if the flux stays.
    #[inline(always)]
    pub fn step_bodies(
        &mut self,
        conductance: Option<&ContactConductance>,
        before: &BodiesBeforeContact<'_>,
    ) -> SurfaceChanges {
        let Bodies { finger, object, .. } = before.bodies;
        let Some(skin) = self.skin.tissue() else {
            return SurfaceChanges::default();
        };
        let into_object = conductance.map(|conductance| {
            let difference = (before.skin_above_object)
                .saturating_sub(skin.free_response())
                .saturating_sub(self.object.free_response());
            conductance.scaled_flux_by(difference)
        });
        let into_skin =
            flux_beyond_air(finger, into_object, skin.free_response(), before.skin_above_room);
        skin.step(into_skin, &finger.tissue.relaxations());
        self.scaled_flux = into_object.unwrap_or(Celsius::ZERO);
        let flux = object.scaled(self.scaled_flux);
        self.object.step(flux, &object.body.relaxations());
        SurfaceChanges {
            cooling: skin.response_to(into_skin, &finger.tissue.relaxations()),
            warming: (self.object).response_to(flux, &object.body.relaxations()),
        }
    }

    /// The set-point by Eq. 6-12, °C: the temperature of the simulated skin's surface, less the temperature drop that
    /// the simulated heat flow would cause across the display's contact, for two half-spaces. `skin_above_object` is the
    /// skin's temperature minus the object's, both before contact, K. `skin_state_on_display` is `None` during contact.
    /// While no finger touches, it is the state of the real skin, whose surface temperature is then used in place of the
    /// simulated one, because the real skin is the one that lands next.
    pub fn setpoint(
        &self,
        factors: &ContactPairFactors,
        skin_before_contact: Celsius,
        skin_above_object: Celsius,
        skin_state_on_display: Option<&SkinState>,
    ) -> Celsius {
        let SkinState::HalfSpace(state) = &self.skin else {
            return skin_before_contact;
        };
        let cooling = state.response_to(self.scaled_flux);
        // Temperature steps in 2^-22 K; the product has 38 places and up to 63 bits.
        let step_at_interface = (i64::from(cooling.to_bits())
            * i64::from(factors.inverse_weight.to_bits()))
            >> U16F16::FRAC_NBITS;
        let step_at_object =
            Celsius::limited(i64::from(skin_above_object.to_bits()) - step_at_interface);
        let step_at_display = (i64::from(step_at_object.to_bits())
            * i64::from(factors.ratio.to_bits()))
            >> Ratio::FRAC_NBITS;
        let skin_cooling = skin_state_on_display.map_or(cooling, SkinState::free_response);
        Celsius::limited(
            i64::from(skin_before_contact.to_bits())
                - i64::from(skin_cooling.to_bits())
                - step_at_display,
        )
    }

    /// Correction to be added to the set-point, K, so that in 20 ticks of 1 ms the real skin on the display has the
    /// temperature of the simulated skin on the object, if the correction stays; negative if the display must cool the
    /// real skin more. It is computed again in each tick of a contact. `display` is the conductance of the contact of
    /// skin and display.
    #[inline(always)]
    pub fn skin_matching_correction(
        &self,
        skin_state_on_display: &SkinState,
        display: &ContactConductance,
        bodies: Option<&Bodies>,
    ) -> Celsius {
        let scaled_flux = match (skin_state_on_display, &self.skin, bodies) {
            (SkinState::HalfSpace(from), SkinState::HalfSpace(to), None) => {
                from.scaled_flux_to_match(to)
            }
            (SkinState::Body(from), SkinState::Body(to), Some(Bodies { finger, .. })) => {
                from.scaled_flux_to_match(to, &finger.tissue.relaxations())
            }
            _ => Celsius::ZERO,
        };
        display.temperature_drop(scaled_flux).saturating_neg()
    }
}

#[cfg(test)]
mod tests;

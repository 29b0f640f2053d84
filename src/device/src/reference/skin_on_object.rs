//! The skin as it would be on the object, followed from the heat that would flow, whatever force and timing did to it.
//!
//! From it follows Eq. 6-12 where its closed form does not hold: under a changing force, or in a second contact.

use contact_model::fixed_point::{
    Celsius, ContactConductance, ContactPair, Fraction, HalfSpace, Ratio, saturating_product,
};
use fixed::types::U16F16;

/// Constants of Eq. 6-12 for one pair of skin and object. The default, for no pair, has zeros, with which no heat
/// flows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairFactors {
    /// Part of the initial temperature difference by which a long contact cools the skin: `e_object / (e_object +
    /// e_skin)`, with effusivities `e`.
    weight: Fraction,
    /// Reciprocal of the weight, `(e_object + e_skin) / e_object`; turns the skin's cooling into the change at the
    /// interface.
    inverse_weight: U16F16,
    /// Contact resistance of skin to display divided by that of skin to object, `R_display / R_object`. It scales the
    /// temperature drop across the object's contact to the drop that the same heat flow causes across the display's contact.
    ratio: Ratio,
}

impl PairFactors {
    /// Computes the factors of a pair, with one 64-bit division; only when the presented object has changed.
    #[must_use]
    pub fn new(pair: &ContactPair) -> Self {
        // 1 in 2^-48 over the weight in 2^-32.
        let inverse = (1u64 << 48) / u64::from(pair.weight().to_bits().max(1));
        Self {
            weight: pair.weight(),
            inverse_weight: U16F16::from_bits(inverse.min(u64::from(u32::MAX)) as u32),
            ratio: pair.ratio(),
        }
    }

    /// Whether these factors were computed for this pair.
    #[must_use]
    pub fn are_those_of(&self, pair: &ContactPair) -> bool {
        self.weight == pair.weight() && self.ratio == pair.ratio()
    }
}

/// Simulates the skin as it would be on the presented object, tick by tick, from the heat that would flow into the
/// object under the measured force.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SkinOnObject {
    /// Temperature change of the skin's surface by that heat, K, counted positive when it cools.
    cooling: HalfSpace,
    /// Heat flow of this tick, as the temperature step, K, that it causes at the skin's surface.
    scaled_flux: Celsius,
}

impl SkinOnObject {
    /// Starts a contact with an object at its initial temperature, by a skin that is as warm or cold as the display has
    /// left it.
    pub fn restart_contact(&mut self, skin_on_display: &HalfSpace) {
        self.cooling = skin_on_display.staggered();
        self.scaled_flux = Celsius::ZERO;
    }

    /// Advances the skin by one tick. `skin_above_object` is the temperature difference before contact, K. With
    /// `conductance` `None` no finger touches, and the skin recovers.
    pub fn step(
        &mut self,
        conductance: Option<&ContactConductance>,
        factors: &PairFactors,
        skin_above_object: Celsius,
    ) {
        self.scaled_flux = conductance.map_or(Celsius::ZERO, |conductance| {
            let without_resistance = saturating_product(skin_above_object, factors.weight);
            conductance.scaled_flux(without_resistance, &self.cooling)
        });
        self.cooling.step(self.scaled_flux);
    }

    /// The display temperature by Eq. 6-12, °C, for the simulated skin. Between contacts `skin_on_display` is given,
    /// because the skin that will land is the one that the display has left, which need not be the simulated one.
    #[must_use]
    pub fn setpoint(
        &self,
        factors: &PairFactors,
        skin_before_contact: Celsius,
        skin_above_object: Celsius,
        skin_on_display: Option<&HalfSpace>,
    ) -> Celsius {
        let cooling = self.cooling.response_to(self.scaled_flux);
        // Temperature steps in 2^-22 K; the product has 38 places and up to 63 bits.
        let step_at_interface = (i64::from(cooling.to_bits())
            * i64::from(factors.inverse_weight.to_bits()))
            >> U16F16::FRAC_NBITS;
        let step_at_object =
            saturating_celsius(i64::from(skin_above_object.to_bits()) - step_at_interface);
        let step_at_display = (i64::from(step_at_object.to_bits())
            * i64::from(factors.ratio.to_bits()))
            >> Ratio::FRAC_NBITS;
        let skin_cooling = skin_on_display.map_or(cooling, HalfSpace::free_response);
        saturating_celsius(
            i64::from(skin_before_contact.to_bits())
                - i64::from(skin_cooling.to_bits())
                - step_at_display,
        )
    }

    /// What must be added to the set-point, K, for the skin on the display to reach the temperature that it would have
    /// on the object within the matching horizon of the half-space.
    #[must_use]
    pub fn setpoint_correction(
        &self,
        skin_on_display: &HalfSpace,
        display: &ContactConductance,
    ) -> Celsius {
        let scaled_flux = skin_on_display.scaled_flux_to_match(&self.cooling);
        display.temperature_drop(scaled_flux).saturating_neg()
    }
}

/// A temperature from 64 bits in units of 2^-22 K, limited to the range of its type (±512 °C).
fn saturating_celsius(bits: i64) -> Celsius {
    Celsius::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
}

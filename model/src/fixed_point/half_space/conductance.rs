//! Contact resistance in series with a half-space.

use fixed::types::{I4F28, I12F20, U0F32, U16F16};

use super::{HalfSpace, TICK_GAIN};
use crate::fixed_point::{
    Body, Celsius, Contact, ContactPair, Fraction, Log2, MantissaExponent, OwnContactLaw, Ratio,
    ScaledBody, product, saturating_product,
};

/// A contact resistance in series with a [`HalfSpace`], for one tick: gives the scaled flux for a temperature
/// difference, and the temperature difference for a scaled flux. The default conducts nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactConductance {
    /// Scaled flux per kelvin between the body in front of the resistance and the free response of the surface:
    /// the resistance and the half-space's own response of one tick, in series.
    series: U0F32,
    /// Temperature difference across the resistance per kelvin of scaled flux.
    resistance: U16F16,
}

/// A body's response of one tick in the binary places of a resistance, rounded. At least 1, as that of any finger is.
const fn tick_resistance(tick_gain: I12F20) -> u32 {
    const FEWER: u32 = I12F20::FRAC_NBITS - U16F16::FRAC_NBITS;
    let bits = tick_gain.to_bits();
    let bits = if bits < 1 << I12F20::FRAC_NBITS { 1 << I12F20::FRAC_NBITS } else { bits as u32 };
    (bits + (1 << FEWER >> 1)) >> FEWER
}

impl ContactConductance {
    /// A resistance in series with bodies whose responses of one tick add up to `tick_gain`. The series conductance has a
    /// relative error of at most 1e-5.
    const fn new(resistance: U16F16, tick_gain: I12F20) -> Self {
        // At least 1, so at most 15 zeros lead it.
        let total = resistance.to_bits().saturating_add(tick_resistance(tick_gain));
        let zeros = total.leading_zeros();
        Self { series: U0F32::from_bits(inverse(total << zeros) << 1 >> (15 - zeros)), resistance }
    }

    /// Scaled flux of the coming tick, K, if the surface would reach a change of `target` kelvin without
    /// the resistance.
    pub fn scaled_flux(&self, target: Celsius, half_space: &HalfSpace) -> Celsius {
        self.scaled_flux_by(target.saturating_sub(half_space.free_response()))
    }

    /// Scaled flux of the coming tick, K, under a temperature difference that counts the free responses of all bodies, K.
    pub fn scaled_flux_by(&self, difference: Celsius) -> Celsius {
        product(difference, self.series)
    }

    /// Temperature difference across the resistance under a scaled flux, both in K; saturates.
    pub fn temperature_drop(&self, scaled_flux: Celsius) -> Celsius {
        saturating_product(scaled_flux, self.resistance)
    }
}

/// Resistances in which the contacts of one finger on one display differ from those of the thesis's skin on a bare display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwnResistances {
    /// Factor of the contact resistance of the finger's skin with any surface.
    pub skin_factor: I4F28,
    /// Resistance of a layer on the display's face, in series with its contact: its temperature difference per kelvin of
    /// scaled flux.
    pub display_layer: U16F16,
    /// The contact law of the finger's skin; `None` for Eq. 6-8.
    pub law: Option<OwnContactLaw>,
}

impl OwnResistances {
    /// Those of the thesis's skin on a bare display.
    pub const NONE: Self = Self { skin_factor: I4F28::ONE, display_layer: U16F16::ZERO, law: None };

    /// The contact of this finger at the pressure given by `log2(P / H)`, without its gap and factor.
    pub fn contact(&self, pair: &ContactPair, log2_relative_pressure: Log2) -> Contact {
        match &self.law {
            None => pair.at_pressure(log2_relative_pressure),
            Some(law) => pair.at_pressure_by(law, log2_relative_pressure),
        }
    }

    /// A resistance of [`Self::contact`] with the gap parallel to it.
    fn with_gap(&self, resistance: U16F16) -> U16F16 {
        match &self.law {
            None => resistance,
            Some(law) => law.with_gap(resistance),
        }
    }

    /// The resistance of this finger's contact, where that of [`Self::contact`] is `resistance`; saturates.
    fn of_contact(&self, resistance: U16F16) -> U16F16 {
        saturating_product(self.skin_factor, self.with_gap(resistance))
    }
}

/// `2^62 / n` for `n` from 2^31 on: below 2^31, relative error below 2^-28. A 32-bit division and one step of
/// Newton's method, because a 64-bit division costs three hundred cycles.
pub const fn inverse(n: u32) -> u32 {
    // 2^48 / n, relative error below 2^-15.
    let estimate = (u32::MAX / (n >> 16 | 1 << 15)) as i64;
    let residual = (1 << 48) - estimate * n as i64;
    ((estimate << 14) + ((estimate * (residual >> 17)) >> 17)) as u32
}

/// `ratio / (rate weight)`; saturates.
#[inline(never)]
fn resistance(ratio: Ratio, rate: MantissaExponent, weight: Fraction) -> U16F16 {
    let product = u64::from(rate.leading()) * u64::from(weight.to_bits());
    let zeros = product.leading_zeros();
    let Some(leading) = product.checked_shl(zeros) else {
        return U16F16::MAX;
    };
    let quotient = u64::from(ratio.to_bits()) * u64::from(inverse((leading >> 32) as u32));
    // From the binary places of the quotient to those of a resistance. The product has 31 + 32 places, and the
    // inverse leaves out 32 of them.
    const DOWN: i32 = (Ratio::FRAC_NBITS + 62 - (31 + 32 - 32) - U16F16::FRAC_NBITS) as i32;
    U16F16::from_bits(match DOWN + rate.exponent() - zeros as i32 {
        _ if quotient == 0 => 0,
        64.. => 0,
        down @ 0..64 => (quotient >> down).min(u64::from(u32::MAX)) as u32,
        _ => u32::MAX,
    })
}

impl Contact {
    /// Conductance between skin and object. The [`HalfSpace`] is the cooling of the skin's surface on the
    /// object; its target is `w (T_skin,i - T_object,i)`.
    pub fn object_conductance(&self) -> ContactConductance {
        ContactConductance::new(
            resistance(Ratio::ONE, self.root_rate_per_tick, Fraction::MAX),
            TICK_GAIN,
        )
    }

    /// Conductance between skin and display. The [`HalfSpace`] is the cooling of the skin's surface on the
    /// display; its target is `T_skin,i - T_display`.
    pub fn display_conductance(&self) -> ContactConductance {
        ContactConductance::new(self.display_resistance(), TICK_GAIN)
    }

    /// Conductance between skin and display, for a finger that is another [`super::super::Body`].
    pub fn display_conductance_of(&self, skin: &Body, own: &OwnResistances) -> ContactConductance {
        let of_contact = own.of_contact(self.display_resistance());
        ContactConductance::new(of_contact.saturating_add(own.display_layer), skin.tick_gain())
    }

    /// Conductance between the bodies of skin and object. Its target is `T_skin,i - T_object,i`, less the free responses
    /// of both.
    pub fn conductance_of(
        &self,
        skin: &Body,
        object: &ScaledBody,
        own: &OwnResistances,
    ) -> ContactConductance {
        ContactConductance::new(
            own.of_contact(self.object_resistance()),
            skin.tick_gain().saturating_add(object.tick_gain()),
        )
    }

    /// Resistance between skin and display over that between skin and object, as [`Self::ratio`], with a finger's own ones.
    pub fn ratio_of(&self, own: &OwnResistances) -> Ratio {
        let object = own.of_contact(self.object_resistance()).to_bits().max(1);
        if own.law.is_some_and(|law| law.has_gap()) {
            let display =
                own.of_contact(self.display_resistance()).saturating_add(own.display_layer);
            let ratio = (u64::from(display.to_bits()) << Ratio::FRAC_NBITS) / u64::from(object);
            return Ratio::from_bits(ratio.min(Ratio::MAX.to_bits().into()) as u32);
        }
        // Both have the same binary places.
        let layer =
            (u64::from(own.display_layer.to_bits()) << Ratio::FRAC_NBITS) / u64::from(object);
        let layer = Ratio::from_bits(layer.min(Ratio::MAX.to_bits().into()) as u32);
        self.ratio.saturating_add(layer)
    }

    /// Resistance between skin and display without a factor that was learnt, and without the layer: its temperature difference
    /// per kelvin of scaled flux.
    pub fn expected_display_resistance(&self, own: &OwnResistances) -> U16F16 {
        own.with_gap(self.display_resistance())
    }

    fn display_resistance(&self) -> U16F16 {
        resistance(self.ratio, self.root_rate_per_tick, self.weight)
    }

    fn object_resistance(&self) -> U16F16 {
        resistance(Ratio::ONE, self.root_rate_per_tick, self.weight)
    }
}

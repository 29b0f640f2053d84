//! Parameters of the contact between a finger and a material, reproduced by a display surface.

use super::properties::{ContactPairError, check, moderate, rate};
use super::{
    Celsius, Contact, Fraction, Log2, MantissaExponent, OwnContactLaw, Ratio, contact, logarithm,
    to_fixed,
};
use crate::material::{Material, Surface};
use crate::reference;

/// Parameters of a skin, an object and a display surface in contact; independent of force and temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactPair {
    weight: Fraction,
    ratio: Ratio,
    /// `b² dt` where the pressure equals the microhardness of the skin.
    rate_per_tick: MantissaExponent,
    /// `b sqrt(dt)` there.
    root_rate_per_tick: MantissaExponent,
    /// Contact conductance there.
    conductance_w_m2k: MantissaExponent,
}

impl ContactPair {
    /// Derives the parameters in `f64` for ticks of `tick_s` seconds (any positive number; `b² dt` saturates at the
    /// ends of `f64`). Errors are those of rounding: of the weight 2^-33 (2^-32 near 1), of the ratio 2^-29, of
    /// `b² dt` and the conductance a relative 2^-32.
    ///
    /// # Errors
    /// A property that is not positive and finite, or a parameter outside the range of its type.
    pub fn new(
        skin: &Material,
        object: &Material,
        display: &Surface,
        tick_s: f64,
    ) -> Result<Self, ContactPairError> {
        check(skin, object, display, tick_s)?;
        let (es, eo) = (skin.effusivity(), object.effusivity());
        let conductance =
            moderate(reference::conductance_at_hardness::<f64>(&skin.surface, &object.surface))?;
        let ratio = conductance / reference::conductance_at_hardness::<f64>(&skin.surface, display);
        if ratio >= f64::from(1 << Ratio::INT_NBITS) {
            return Err(ContactPairError::Ratio(ratio));
        }
        let b = (1.0 / es + 1.0 / eo) * conductance;
        Ok(Self {
            ratio: to_fixed(ratio),
            rate_per_tick: rate(moderate(b * b)? * tick_s)?,
            root_rate_per_tick: rate(b * libm::sqrt(tick_s))?,
            conductance_w_m2k: rate(conductance)?,
            weight: to_fixed(1.0 / (1.0 + es / eo)),
        })
    }

    /// `w = e_object / (e_object + e_skin)`: fraction of the initial temperature difference by which the skin's
    /// surface changes in a long contact (Eq. 3-1).
    pub const fn weight(&self) -> Fraction {
        self.weight
    }

    /// Ratio of contact resistances, `R_display / R_object`.
    pub const fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// Contact under the pressure `P` given by `log2(P / H)`, with `H` the microhardness of the skin (Eq. 6-8). Any
    /// logarithm is allowed. Within ±64 the relative error is below 2^-29 for `b² dt` and 2^-30 for the conductance;
    /// with that of [`super::log2_relative_pressure`] at most 4e-9 and 2e-9.
    pub fn at_pressure(&self, log2_relative_pressure: Log2) -> Contact {
        self.with_pressure_term(logarithm::power_0_95(log2_relative_pressure))
    }

    /// [`Self::at_pressure`] by a law of the finger's own, without its gap, which [`super::OwnResistances`] have.
    pub fn at_pressure_by(&self, law: &OwnContactLaw, log2_relative_pressure: Log2) -> Contact {
        self.with_pressure_term(law.power(log2_relative_pressure))
    }

    #[inline(never)]
    fn with_pressure_term(&self, log2: Log2) -> Contact {
        let pressure_term = MantissaExponent::from_log2(log2);
        Contact {
            weight: self.weight,
            ratio: self.ratio,
            rate_per_tick: self.rate_per_tick.times(pressure_term).times(pressure_term),
            root_rate_per_tick: self.root_rate_per_tick.times(pressure_term),
            conductance_w_m2k: self.conductance_w_m2k.times(pressure_term),
        }
    }

    /// Display temperature at landing, °C, to which the display is set before contact (Eq. 6-12 at `t = 0`);
    /// independent of pressure. Error below 0.15 µK + 2^-29 times the temperature difference of skin and object.
    pub fn preset(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::preset(self.ratio, skin_c, object_c)
    }

    /// Temperature of both surfaces in perfect contact, °C (Eq. 3-1); error below 0.16 µK.
    pub fn interface_temperature(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::interface(self.weight, skin_c, object_c)
    }
}

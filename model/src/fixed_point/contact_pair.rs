//! A finger, a material and a display surface, reduced to the numbers that a tick needs.

use super::properties::{
    ContactPairError, check, moderate, of_display, of_object, of_skin, rate, weight,
};
use super::{Celsius, Contact, Fraction, Log2, MantissaExponent, Ratio, contact, logarithm};
use crate::material::{Material, Surface};
use crate::reference;

/// One material under a finger, on one display; does not change with force or temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactPair {
    weight: Fraction,
    ratio: Ratio,
    /// `b² dt`, its root and conductance at `P = H`.
    rate_per_tick: MantissaExponent,
    root_rate_per_tick: MantissaExponent,
    conductance_w_m2k: MantissaExponent,
}

impl ContactPair {
    /// Derives the numbers, in `f64`, for ticks of `tick_s` seconds (any above 0; where `b² dt` leaves the range
    /// of `f64` it saturates). Errors are those of rounding: `w` 2^-33 (2^-32 beside one), `r` 2^-29, `b² dt` and
    /// the conductance 2^-32 of themselves.
    ///
    /// # Errors
    /// A property that is not positive and finite, or a result outside of the range of its type.
    pub fn new(
        skin: &Material,
        object: &Material,
        display: &Surface,
        tick_s: f64,
    ) -> Result<Self, ContactPairError> {
        check(of_skin(skin))?;
        check(of_object(object))?;
        check(of_display(display))?;
        check([("tick (s)", tick_s)])?;
        let (es, eo) = (skin.effusivity(), object.effusivity());
        let conductance = moderate(reference::mean_conductance::<f64>(
            &skin.surface,
            &object.surface,
        ))?;
        let ratio = conductance / reference::mean_conductance::<f64>(&skin.surface, display);
        let b = (1.0 / es + 1.0 / eo) * conductance;
        Ok(Self {
            ratio: Ratio::checked_from_num(ratio).ok_or(ContactPairError::Ratio(ratio))?,
            rate_per_tick: rate(moderate(b * b)? * tick_s)?,
            root_rate_per_tick: rate(b * libm::sqrt(tick_s))?,
            conductance_w_m2k: rate(conductance)?,
            weight: Fraction::saturating_from_num(weight(es, eo)),
        })
    }

    /// `e_object / (e_object + e_skin)`: the part of the way to the object's temperature that the skin goes
    /// in the end (Eq. 3-1).
    #[must_use]
    pub const fn weight(&self) -> Fraction {
        self.weight
    }

    /// `R_display / R_object`.
    #[must_use]
    pub const fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// The contact under a pressure, given as `log2(P / H)`, any (Eq. 6-8). Relative error, beside that of the
    /// logarithm, of `b² dt` below 2^-29, of the conductance below 2^-30, for logarithms within ±64; together
    /// with [`super::log2_relative_pressure`] at most 4e-9 and 2e-9.
    #[must_use]
    pub fn at_pressure(&self, log2_relative_pressure: Log2) -> Contact {
        let pressure_term =
            MantissaExponent::from_log2(logarithm::power_0_95(log2_relative_pressure));
        Contact {
            weight: self.weight,
            ratio: self.ratio,
            rate_per_tick: self.rate_per_tick.times(pressure_term).times(pressure_term),
            root_rate_per_tick: self.root_rate_per_tick.times(pressure_term),
            conductance_w_m2k: self.conductance_w_m2k.times(pressure_term),
        }
    }

    /// Display temperature at `t = 0`, which is also what it is preset to before contact (Eq. 6-12);
    /// does not depend on pressure. Error below 0.15 µK + 2^-29 of the difference of the temperatures.
    #[must_use]
    pub fn preset(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::preset(self.ratio, skin_c, object_c)
    }

    /// Interface temperature of perfect contact (Eq. 3-1); error below 0.16 µK.
    #[must_use]
    pub fn interface_temperature(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        contact::interface(self.weight, skin_c, object_c)
    }
}

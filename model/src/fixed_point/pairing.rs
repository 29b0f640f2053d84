//! A finger, a material and a display surface, reduced to the numbers that a tick needs.

use core::fmt;

use super::{Celsius, Contact, Fraction, Log2, Rate, Ratio};
use crate::material::{Material, Surface};
use crate::reference;

/// Exponent of pressure in `b²`: twice that of Eq. 6-8.
const RATE_EXPONENT: Log2 = Log2::lit("1.9");
/// Exponent of pressure in Eq. 6-8.
const CONDUCTANCE_EXPONENT: Log2 = Log2::lit("0.95");

/// One material under a finger, on one display; does not change with force or temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pairing {
    weight: Fraction,
    ratio: Ratio,
    log2_rate: Log2,
    log2_conductance: Log2,
}

/// A material that the fixed-point path cannot hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairingError {
    /// A property is zero, negative or not a number.
    Property {
        /// Which one, with its unit.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// `R_display / R_object` does not fit: the object is too smooth or conducts too well.
    Ratio(f64),
    /// `b² dt` or the conductance at `P = H` is beyond 2^±100.
    Rate(f64),
}

impl fmt::Display for PairingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Property { name, value } => write!(f, "{name} is {value}; it must be above 0"),
            Self::Ratio(value) => write!(f, "R_display / R_object is {value}; it must be below 16"),
            Self::Rate(value) => write!(
                f,
                "the contact's rate is {value}; it must be within 2^-100 to 2^100"
            ),
        }
    }
}

impl core::error::Error for PairingError {}

impl Pairing {
    /// Derives the numbers, in `f64`, for ticks of `tick_s` seconds.
    ///
    /// # Errors
    /// A property that is not positive, or a result outside of the range of its type.
    pub fn new(
        skin: &Material,
        object: &Material,
        display: &Surface,
        tick_s: f64,
    ) -> Result<Self, PairingError> {
        for (name, value) in [
            ("conductivity (W/mK)", object.surface.conductivity_w_mk),
            ("density (kg/m3)", object.density_kg_m3),
            ("specific heat (J/kgK)", object.specific_heat_j_kgk),
            ("roughness (um)", object.surface.roughness_um),
            ("slope (rad)", object.surface.slope_rad),
        ] {
            // Not `value <= 0.0`: that would let NaN pass.
            if !(value > 0.0 && value.is_finite()) {
                return Err(PairingError::Property { name, value });
            }
        }
        let (es, eo) = (skin.effusivity(), object.effusivity());
        let conductance = reference::mean_conductance::<f64>(&skin.surface, &object.surface);
        let ratio = conductance / reference::mean_conductance::<f64>(&skin.surface, display);
        let b = (1.0 / es + 1.0 / eo) * conductance;
        Ok(Self {
            weight: Fraction::saturating_from_num(eo / (eo + es)),
            ratio: Ratio::checked_from_num(ratio).ok_or(PairingError::Ratio(ratio))?,
            log2_rate: log2_of(b * b * tick_s)?,
            log2_conductance: log2_of(conductance)?,
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

    /// The contact under a pressure, given as `log2(P / H)`; relative error of `b² dt` and of the conductance
    /// below 2^-20.
    #[must_use]
    pub fn under(&self, log2_relative_pressure: Log2) -> Contact {
        let scaled = |constant: Log2, exponent: Log2| {
            constant.saturating_add(log2_relative_pressure.saturating_mul(exponent))
        };
        Contact {
            weight: self.weight,
            ratio: self.ratio,
            per_tick: Rate::from_log2(scaled(self.log2_rate, RATE_EXPONENT)),
            conductance_w_m2k: Rate::from_log2(scaled(self.log2_conductance, CONDUCTANCE_EXPONENT)),
        }
    }

    /// Display temperature at `t = 0`, which is also what it is preset to before contact (Eq. 6-12);
    /// does not depend on pressure. Error below 1 µK.
    #[must_use]
    pub fn preset(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        skin_c.saturating_sub(super::contact::scaled(
            skin_c.saturating_sub(object_c),
            self.ratio,
        ))
    }

    /// Interface temperature of perfect contact (Eq. 3-1); error below 1 µK.
    #[must_use]
    pub fn interface_temperature(&self, skin_c: Celsius, object_c: Celsius) -> Celsius {
        let step = skin_c.saturating_sub(object_c);
        skin_c.saturating_sub(super::contact::part(step, self.weight))
    }
}

fn log2_of(value: f64) -> Result<Log2, PairingError> {
    let log2 = libm::log2(value);
    if log2.abs() <= 100.0 {
        Ok(Log2::from_num(log2))
    } else {
        Err(PairingError::Rate(value))
    }
}

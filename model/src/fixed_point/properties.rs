//! Checks of material properties before they are converted to fixed point.

use core::f64::consts::LOG2_E;
use core::fmt;

use super::MantissaExponent;
use crate::decimal::{Rounded, Shortest};
use crate::material::{Material, Surface};

/// A material, surface or tick that fixed point cannot represent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactPairError {
    /// A property is zero, negative, infinite or not a number.
    Property {
        /// Name of the property, with its unit.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// `R_display / R_object` is 16 or more: the object is too smooth or conducts too well.
    Ratio(f64),
    /// `b²` (1/s) or the conductance (W/(m² K)) at `P = H` is outside 2^-100 to 2^100.
    OutOfRange(f64),
}

impl fmt::Display for ContactPairError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Property { name, value } => {
                let value = Shortest(*value);
                write!(f, "{name} is {value}; it must be above 0 and finite")
            }
            Self::Ratio(value) => {
                let value = Rounded(*value, 2);
                write!(f, "R_display / R_object is {value}; it must be below 16")
            }
            Self::OutOfRange(value) => {
                let exponent = Rounded(libm::log(*value) * LOG2_E, 2);
                write!(f, "the contact's rate is 2^{exponent}; it must be within 2^-100 to 2^100")
            }
        }
    }
}

impl core::error::Error for ContactPairError {}

/// Refuses properties that are not positive and finite.
pub(super) fn check(
    skin: &Material,
    object: &Material,
    display: &Surface,
    tick_s: f64,
) -> Result<(), ContactPairError> {
    [
        ("skin conductivity (W/mK)", skin.surface.conductivity_w_mk),
        ("skin density (kg/m3)", skin.density_kg_m3),
        ("skin specific heat (J/kgK)", skin.specific_heat_j_kgk),
        ("skin roughness (um)", skin.surface.roughness_um),
        ("skin slope (rad)", skin.surface.slope_rad),
        ("conductivity (W/mK)", object.surface.conductivity_w_mk),
        ("density (kg/m3)", object.density_kg_m3),
        ("specific heat (J/kgK)", object.specific_heat_j_kgk),
        ("roughness (um)", object.surface.roughness_um),
        ("slope (rad)", object.surface.slope_rad),
        ("display conductivity (W/mK)", display.conductivity_w_mk),
        ("display roughness (um)", display.roughness_um),
        ("display slope (rad)", display.slope_rad),
        ("tick (s)", tick_s),
    ]
    .into_iter()
    .find(|(_, value)| !is_positive_and_finite(*value))
    .map_or(Ok(()), |(name, value)| Err(ContactPairError::Property { name, value }))
}

/// Not inlined, because it is asked fourteen times.
#[inline(never)]
fn is_positive_and_finite(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// Refuses values outside 2^-100 to 2^100, so that their products stay within `f64` and [`MantissaExponent`].
pub(super) fn moderate(value: f64) -> Result<f64, ContactPairError> {
    const LARGEST: f64 = (1u128 << 100) as f64;
    if (1.0 / LARGEST..=LARGEST).contains(&value) {
        Ok(value)
    } else {
        Err(ContactPairError::OutOfRange(value))
    }
}

/// Converts a value that an extreme tick may have taken to 0 or infinity; saturates at the ends of `f64`.
pub(super) fn rate(value: f64) -> Result<MantissaExponent, ContactPairError> {
    MantissaExponent::from_f64(value.clamp(f64::MIN_POSITIVE, f64::MAX))
        .ok_or(ContactPairError::OutOfRange(value))
}

//! What a material must be to be held in fixed point.

use core::fmt;

use super::MantissaExponent;
use crate::material::{Material, Surface};

/// A material that the fixed-point path cannot hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactPairError {
    /// A property is zero, negative, infinite or not a number.
    Property {
        /// Which one, with its unit.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// `R_display / R_object` does not fit: the object is too smooth or conducts too well.
    Ratio(f64),
    /// `b²` (1/s), the conductance (W/(m² K)) at `P = H`, or the skin's effusivity or diffusivity is beyond 2^±100.
    MantissaExponent(f64),
}

impl fmt::Display for ContactPairError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Property { name, value } => {
                write!(f, "{name} is {value}; it must be above 0 and finite")
            }
            Self::Ratio(value) => write!(f, "R_display / R_object is {value}; it must be below 16"),
            Self::MantissaExponent(value) => write!(
                f,
                "the contact's rate is {value}; it must be within 2^-100 to 2^100"
            ),
        }
    }
}

impl core::error::Error for ContactPairError {}

/// Properties by name and value.
type Named<const N: usize> = [(&'static str, f64); N];

pub(super) fn check<const N: usize>(properties: Named<N>) -> Result<(), ContactPairError> {
    properties
        .into_iter()
        // Not `value <= 0.0`: that would let NaN pass.
        .find(|(_, value)| !(*value > 0.0 && value.is_finite()))
        .map_or(Ok(()), |(name, value)| {
            Err(ContactPairError::Property { name, value })
        })
}

pub(super) fn of_skin(skin: &Material) -> Named<5> {
    [
        ("skin conductivity (W/mK)", skin.surface.conductivity_w_mk),
        ("skin density (kg/m3)", skin.density_kg_m3),
        ("skin specific heat (J/kgK)", skin.specific_heat_j_kgk),
        ("skin roughness (um)", skin.surface.roughness_um),
        ("skin slope (rad)", skin.surface.slope_rad),
    ]
}

pub(super) fn of_object(object: &Material) -> Named<5> {
    [
        ("conductivity (W/mK)", object.surface.conductivity_w_mk),
        ("density (kg/m3)", object.density_kg_m3),
        ("specific heat (J/kgK)", object.specific_heat_j_kgk),
        ("roughness (um)", object.surface.roughness_um),
        ("slope (rad)", object.surface.slope_rad),
    ]
}

pub(super) fn of_display(display: &Surface) -> Named<3> {
    [
        ("display conductivity (W/mK)", display.conductivity_w_mk),
        ("display roughness (um)", display.roughness_um),
        ("display slope (rad)", display.slope_rad),
    ]
}

/// The value, if it is far from the ends of what a [`MantissaExponent`] can hold.
pub(super) fn moderate(value: f64) -> Result<f64, ContactPairError> {
    if libm::log2(value).abs() <= 100.0 {
        Ok(value)
    } else {
        Err(ContactPairError::MantissaExponent(value))
    }
}

/// A moderate value, times a power of a duration that may be extreme; saturates at the ends of `f64`.
pub(super) fn rate(value: f64) -> Result<MantissaExponent, ContactPairError> {
    MantissaExponent::from_f64(value.clamp(f64::MIN_POSITIVE, f64::MAX))
        .ok_or(ContactPairError::MantissaExponent(value))
}

/// `e_object / (e_object + e_skin)`, for a skin's effusivity that is neither 0 nor infinite.
pub(super) fn weight(e_skin: f64, e_object: f64) -> f64 {
    1.0 / (1.0 + e_skin / e_object)
}

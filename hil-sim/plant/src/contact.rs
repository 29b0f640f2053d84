//! Contact area and contact resistance of skin pressed on a surface.

use contact_model::material::Surface;
use contact_model::pressure::{contact_area_m2, pressure_pa};
use contact_model::reference::contact_resistance;

/// A closed contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinContact {
    /// Contact area, m2.
    pub area_m2: f64,
    /// Thermal contact resistance, m2 K/W.
    pub resistance_m2k_w: f64,
}

impl SkinContact {
    /// Skin pressed on another surface by a force, N: area interpolated between the thesis's five measurements,
    /// resistance by Eq. 6-8 to 6-11 at the mean pressure. None without force.
    #[must_use]
    pub fn at_force(force_n: f64, skin: &Surface, other: &Surface) -> Option<Self> {
        (force_n > 0.0).then(|| Self {
            area_m2: contact_area_m2(force_n),
            resistance_m2k_w: contact_resistance(skin, other, pressure_pa(force_n)),
        })
    }
}

/// Largest relative change of the contact resistance that a full step resolves.
const LARGEST_SMOOTH_CHANGE: f64 = 0.05;

/// Whether a change of contact needs the sub-steps: it opens or closes, or its resistance changes by more than 5 %.
#[must_use]
pub fn is_abrupt(before: Option<SkinContact>, after: Option<SkinContact>) -> bool {
    match (before, after) {
        (None, None) => false,
        (Some(a), Some(b)) => {
            (b.resistance_m2k_w / a.resistance_m2k_w - 1.0).abs() > LARGEST_SMOOTH_CHANGE
        }
        _ => true,
    }
}

//! How a force presses skin against a surface.

use contact_model::material::Surface;
use contact_model::pressure::{contact_area_m2, pressure_pa};
use contact_model::reference::contact_resistance;

/// A contact that is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Area of the contact, m2.
    pub area_m2: f64,
    /// Resistance between the two surfaces, m2 K/W.
    pub resistance_m2k_w: f64,
}

impl Touch {
    /// Skin pressed on another surface by a force, N: area from the thesis's five points, resistance from
    /// Eq. 6-8 to 6-11 at the mean pressure. Without force there is no contact.
    #[must_use]
    pub fn under(force_n: f64, skin: &Surface, other: &Surface) -> Option<Self> {
        (force_n > 0.0).then(|| Self {
            area_m2: contact_area_m2(force_n),
            resistance_m2k_w: contact_resistance(skin, other, pressure_pa(force_n)),
        })
    }
}

/// Largest relative change of the resistance that the ordinary step still follows.
const GENTLE: f64 = 0.05;

/// Whether the surface temperatures change so fast after this that small steps must resolve it.
#[must_use]
pub fn is_event(before: Option<Touch>, after: Option<Touch>) -> bool {
    match (before, after) {
        (None, None) => false,
        (Some(a), Some(b)) => (b.resistance_m2k_w / a.resistance_m2k_w - 1.0).abs() > GENTLE,
        _ => true,
    }
}

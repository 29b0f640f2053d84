//! Contact area and contact resistance of skin pressed on a surface.

use contact_model::material::{SKIN_MICROHARDNESS_PA, Surface};
use contact_model::pressure::contact_area_m2;
use contact_model::reference::{Real, conductance_at_hardness};

/// Contact conductance by Eq. 6-8 and contact area by section 6.4.2 with parameters of the plant's own, and in parallel the
/// conductance of the gap, which the thesis does not model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Conductance of air and sweat in the gap, parallel to that of the spots in contact (Eq. 6-8), W/(m2 K).
    pub gap_w_m2k: f64,
    /// Microhardness of the skin in Eq. 6-8, Pa.
    pub hardness_pa: f64,
    /// Exponent of the relative pressure in Eq. 6-8.
    pub exponent: f64,
    /// Factor on the contact area of section 6.4.2; the pressure is that on the true area.
    pub area_factor: f64,
}

impl ContactLaw {
    /// Eq. 6-8 and section 6.4.2 as the thesis has them.
    pub const NOMINAL: Self = Self {
        gap_w_m2k: 0.0,
        hardness_pa: SKIN_MICROHARDNESS_PA,
        exponent: 0.95,
        area_factor: 1.0,
    };

    /// Contact of skin pressed on another surface by a force, N; `None` without force.
    pub fn at_force(&self, force_n: f64, skin: &Surface, other: &Surface) -> Option<SkinContact> {
        if force_n <= 0.0 {
            return None;
        }
        let area_m2 = self.area_factor * contact_area_m2(force_n);
        let relative = force_n / area_m2 / self.hardness_pa;
        // `Real::powf` in place of `f64::powf`, because it has the same result on every host.
        let spots_w_m2k =
            conductance_at_hardness::<f64>(skin, other) * Real::powf(relative, self.exponent);
        Some(SkinContact { area_m2, resistance_m2k_w: 1.0 / (spots_w_m2k + self.gap_w_m2k) })
    }
}

/// A closed contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinContact {
    /// Contact area, m2.
    pub area_m2: f64,
    /// Thermal contact resistance, m2 K/W.
    pub resistance_m2k_w: f64,
}

/// Largest relative change of the contact resistance that a step of 1 ms resolves without sub-steps.
const LARGEST_SMOOTH_CHANGE: f64 = 0.05;

/// Whether a change of contact needs sub-steps: it opens or closes, or its resistance changes by more than 5 %.
pub fn is_abrupt(before: Option<SkinContact>, after: Option<SkinContact>) -> bool {
    match (before, after) {
        (None, None) => false,
        (Some(a), Some(b)) => {
            (b.resistance_m2k_w / a.resistance_m2k_w - 1.0).abs() > LARGEST_SMOOTH_CHANGE
        }
        _ => true,
    }
}

#[cfg(test)]
mod tests;

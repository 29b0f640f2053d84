//! The surface of the display.

use contact_model::material::{REFERENCE_DISPLAY, Surface};

use super::round_to_decimals;

/// The surface that the finger touches: conductivity, roughness and slope, on which its contact resistance depends; each rounded
/// to [`Self::DECIMALS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplaySurface(Surface);

impl DisplaySurface {
    /// The surface of the reference design.
    pub const NOMINAL: Self = Self(REFERENCE_DISPLAY);

    /// Names of conductivity, roughness and slope in an answer.
    pub const NAMES: [&str; 3] = ["conductivity_w_mk", "roughness_um", "slope_rad"];

    /// Decimals of conductivity, W/(m K), roughness, µm, and slope, rad, in a line of settings and in the record in flash.
    pub const DECIMALS: [i32; 3] = [3, 4, 5];

    /// The surface, for the contact model.
    pub const fn surface(&self) -> &Surface {
        &self.0
    }

    /// Conductivity, roughness and slope, in the order of lines and record.
    pub const fn to_array(&self) -> [f64; 3] {
        [self.0.conductivity_w_mk, self.0.roughness_um, self.0.slope_rad]
    }

    /// A surface of this conductivity, roughness and slope.
    pub fn from_array_rounded(values: [f64; 3]) -> Self {
        let mut rounded = values;
        for (value, decimals) in rounded.iter_mut().zip(Self::DECIMALS) {
            *value = round_to_decimals(*value, decimals);
        }
        let [conductivity_w_mk, roughness_um, slope_rad] = rounded;
        Self(Surface { conductivity_w_mk, roughness_um, slope_rad })
    }
}

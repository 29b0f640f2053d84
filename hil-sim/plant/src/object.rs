//! The real object.

use contact_model::material::Material;

use super::slab::{Back, Layer, Medium};

/// The real object that the display stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectConfig {
    /// What it is made of.
    pub material: Material,
    /// Temperature before contact, deg C.
    pub start_c: f64,
    /// Thickness, m; infinite for the thesis's half-space.
    pub thickness_m: f64,
    /// What lies behind it.
    pub back: Back,
}

impl ObjectConfig {
    /// The thinnest object, m; thinner ones are surfaces of what lies behind them.
    pub const THINNEST_M: f64 = 1e-5;

    /// The thesis's assumption: a half-space.
    #[must_use]
    pub const fn half_space(material: Material, start_c: f64) -> Self {
        Self {
            material,
            start_c,
            thickness_m: f64::INFINITY,
            back: Back::Insulated,
        }
    }

    /// The object as a layer.
    #[must_use]
    pub fn layer(&self) -> Layer {
        Layer {
            thickness_m: self.thickness_m,
            medium: Medium::dead(&self.material),
        }
    }
}

//! The real object that the display reproduces.

use contact_model::material::Material;

use super::slab::{BackBoundary, Layer, Medium};

/// Configuration of the real object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectConfig {
    /// Material.
    pub material: Material,
    /// Temperature before contact, deg C.
    pub start_c: f64,
    /// Thickness, m; infinite for the thesis's half-space.
    pub thickness_m: f64,
    /// Boundary condition at the back.
    pub back: BackBoundary,
}

impl ObjectConfig {
    /// Least thickness, m; a thinner object is a coating of the body behind it.
    pub const THINNEST_M: f64 = 1e-5;

    /// The thesis's assumption: a half-space.
    #[must_use]
    pub const fn half_space(material: Material, start_c: f64) -> Self {
        Self {
            material,
            start_c,
            thickness_m: f64::INFINITY,
            back: BackBoundary::Insulated,
        }
    }

    /// The object as one layer of a slab.
    #[must_use]
    pub fn layer(&self) -> Layer {
        Layer {
            thickness_m: self.thickness_m,
            medium: Medium::without_blood(&self.material),
        }
    }
}

//! The real object that the display reproduces.

use contact_model::material::{Material, Surface};

use super::slab::{BackBoundary, Layer, Medium};

/// Configuration of the real object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectConfig {
    /// The touched surface, which determines the contact resistance.
    pub surface: Surface,
    /// Layers, from the touched face down, which determine the conduction; only the last may be endless.
    pub layers: Vec<Layer>,
    /// Temperature before contact, deg C.
    pub start_c: f64,
    /// Boundary condition behind the last layer.
    pub back: BackBoundary,
}

impl ObjectConfig {
    /// Smallest thickness of a layer, m.
    pub const THINNEST_M: f64 = 1e-5;

    /// A half-space of one material, as the thesis assumes.
    pub fn half_space(material: Material, start_c: f64) -> Self {
        Self {
            surface: material.surface,
            layers: vec![Self::layer(&material, f64::INFINITY)],
            start_c,
            back: BackBoundary::Insulated,
        }
    }

    /// A layer of a material, `thickness_m` metres thick.
    pub fn layer(material: &Material, thickness_m: f64) -> Layer {
        Layer { thickness_m, medium: Medium::without_blood(material) }
    }
}

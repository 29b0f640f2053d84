//! Touched objects: the materials of the thesis, and others given by their properties.

use contact_model::material::{Material, Surface, THESIS_MATERIALS};

/// A material with its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedObject {
    /// Name of the material.
    pub name: &'static str,
    /// Its properties, if the device has no material of that name.
    pub properties: Option<Material>,
}

impl TouchedObject {
    /// The nine materials of the thesis.
    pub fn thesis() -> impl Iterator<Item = Self> {
        THESIS_MATERIALS.into_iter().map(Self::of_thesis)
    }

    /// A material of the thesis, which the device has by name.
    pub const fn of_thesis(name: &'static str) -> Self {
        Self { name, properties: None }
    }
}

/// Materials that are unknown to thesis and device. Conductivity, density and specific heat are handbook values at room
/// temperature; roughness and slope are typical values of such surfaces (float glass, ground metal, planed wood, cut
/// cork), and have not been measured for this.
pub const UNKNOWN_MATERIALS: [TouchedObject; 4] = [
    unknown_material("glass", [1.0, 2500.0, 840.0, 0.05, 0.01]),
    unknown_material("aluminium", [237.0, 2700.0, 897.0, 0.4, 0.05]),
    unknown_material("oak", [0.17, 700.0, 2000.0, 5.0, 0.12]),
    unknown_material("cork", [0.045, 160.0, 1900.0, 20.0, 0.25]),
];

const fn unknown_material(
    name: &'static str,
    [conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad]: [f64; 5],
) -> TouchedObject {
    TouchedObject {
        name,
        properties: Some(Material {
            surface: Surface { conductivity_w_mk, roughness_um, slope_rad },
            density_kg_m3,
            specific_heat_j_kgk,
        }),
    }
}

//! A body that heat enters through one plane surface: layers of tissue or one material, per square metre.

mod equilibrium;
mod lanes;
mod mesh;
mod probe;

pub use equilibrium::{Equilibrium, equilibrium};
pub use lanes::{Lanes, Row};
pub use mesh::{Cell, Grading};
pub use probe::Probe;

use contact_model::material::Material;

/// What a layer consists of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Heat capacity of a volume, J/(m3 K).
    pub capacity_j_m3k: f64,
    /// Heat that blood brings for each kelvin by which it is warmer, W/(m3 K): perfusion times heat capacity of
    /// the blood, of Pennes' equation (Eq. 1-1).
    pub perfusion_w_m3k: f64,
    /// Heat of metabolism, W/m3.
    pub metabolism_w_m3: f64,
}

impl Medium {
    /// A material without blood.
    #[must_use]
    pub fn dead(material: &Material) -> Self {
        Self {
            conductivity_w_mk: material.surface.conductivity_w_mk,
            capacity_j_m3k: material.volumetric_heat_j_m3k(),
            perfusion_w_m3k: 0.0,
            metabolism_w_m3: 0.0,
        }
    }

    fn diffusivity_m2_s(&self) -> f64 {
        self.conductivity_w_mk / self.capacity_j_m3k
    }
}

/// A layer; one that is endless must be the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness, m; infinite for a half-space, which is cut where nothing is felt within the duration.
    pub thickness_m: f64,
    /// What it consists of.
    pub medium: Medium,
}

/// What lies behind the deepest layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Back {
    /// Nothing that takes heat.
    Insulated,
    /// Something of a fixed temperature, deg C, behind a film, W/(m2 K); infinite if the face itself has it.
    Film {
        /// Conductance of the film.
        film_w_m2k: f64,
        /// Temperature behind it.
        temperature_c: f64,
    },
}

/// A slab cut into cells, the surface first; all per square metre.
#[derive(Clone, Debug, PartialEq)]
pub struct Slab {
    /// Heat capacity of each cell, J/(m2 K).
    pub capacity_j_m2k: Vec<f64>,
    /// From each node to the next deeper one, W/(m2 K).
    pub link_w_m2k: Vec<f64>,
    /// From the surface to the first node, m2 K/W.
    pub surface_m2k_w: f64,
    /// From the last node to what lies behind it, W/(m2 K), and its temperature, deg C.
    pub back: (f64, f64),
    /// Exchange of each cell with blood at full flow, W/(m2 K).
    pub blood_w_m2k: Vec<f64>,
    /// Heat of metabolism in each cell, W/m2.
    pub metabolism_w_m2: Vec<f64>,
    /// Depth of each node, m.
    pub depth_m: Vec<f64>,
}

/// Half-spaces are cut for at least this duration, s: deep enough for the receptors.
const SHORTEST_S: f64 = 1.0;
/// Depth of a half-space at rest in lengths over which blood evens temperatures out: `exp(-12)` is 6e-6.
const FELT: f64 = 12.0;

impl Slab {
    /// Cuts layers, of which at least one is given, for a surface that is watched for `duration_s`.
    #[must_use]
    pub fn new(layers: &[Layer], back: Back, duration_s: f64, grading: &Grading) -> Self {
        let mut slab = Self {
            capacity_j_m2k: Vec::new(),
            link_w_m2k: Vec::new(),
            surface_m2k_w: 0.0,
            back: (0.0, 0.0),
            blood_w_m2k: Vec::new(),
            metabolism_w_m2: Vec::new(),
            depth_m: Vec::new(),
        };
        // Width of the next cell in diffusion lengths, depth of its face, and what lies between that and the node
        // before it.
        let (mut next, mut face_m, mut behind_m2k_w) = (grading.first, 0.0, 0.0);
        for Layer {
            thickness_m,
            medium,
        } in layers
        {
            let k = medium.conductivity_w_mk;
            let a = medium.diffusivity_m2_s();
            let thickness_m = if thickness_m.is_finite() {
                *thickness_m
            } else {
                let moved_m = grading.depth * (a * duration_s.max(SHORTEST_S)).sqrt();
                // At rest the surface is felt as deep as the blood lets it.
                let felt_m = if medium.perfusion_w_m3k > 0.0 {
                    FELT * (k / medium.perfusion_w_m3k).sqrt()
                } else {
                    0.0
                };
                moved_m.max(felt_m)
            };
            let cells = mesh::fill(thickness_m, next * a.sqrt(), grading.growth);
            for cell in &cells {
                let ahead_m2k_w = behind_m2k_w + cell.node_m / k;
                if slab.depth_m.is_empty() {
                    slab.surface_m2k_w = ahead_m2k_w;
                } else {
                    slab.link_w_m2k.push(1.0 / ahead_m2k_w);
                }
                slab.depth_m.push(face_m + cell.node_m);
                slab.capacity_j_m2k
                    .push(medium.capacity_j_m3k * cell.width_m);
                slab.blood_w_m2k.push(medium.perfusion_w_m3k * cell.width_m);
                slab.metabolism_w_m2
                    .push(medium.metabolism_w_m3 * cell.width_m);
                behind_m2k_w = (cell.width_m - cell.node_m) / k;
                face_m += cell.width_m;
                next = cell.width_m * grading.growth / a.sqrt();
            }
        }
        if let Back::Film {
            film_w_m2k,
            temperature_c,
        } = back
        {
            slab.back = (1.0 / (behind_m2k_w + 1.0 / film_w_m2k), temperature_c);
        }
        slab
    }

    /// Number of cells, at least one.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.capacity_j_m2k.len()
    }
}

#[cfg(test)]
mod tests;

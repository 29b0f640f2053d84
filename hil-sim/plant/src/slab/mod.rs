//! One-dimensional conduction in the layers of a finger or an object, per square metre of surface.

mod batch;
mod depth_probe;
mod mesh;
mod steady_state;

pub use batch::{SlabBatch, SurfaceEquation};
pub use depth_probe::DepthProbe;
pub use mesh::{Cell, Grading};
pub use steady_state::{SteadyState, steady_state};

use contact_model::material::Material;

/// Material of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Volumetric heat capacity, J/(m3 K).
    pub capacity_j_m3k: f64,
    /// Perfusion times volumetric heat capacity of blood, W/(m3 K): the exchange coefficient of Pennes' equation
    /// (Eq. 1-1).
    pub perfusion_w_m3k: f64,
    /// Metabolic heat, W/m3.
    pub metabolism_w_m3: f64,
}

impl Medium {
    /// A material without perfusion and metabolism.
    pub fn without_blood(material: &Material) -> Self {
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

/// A layer; one of infinite thickness must be the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness, m; infinite for a half-space, which is meshed as deep as heat diffuses in the simulated time.
    pub thickness_m: f64,
    /// Material.
    pub medium: Medium,
}

/// Boundary condition behind the deepest layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BackBoundary {
    /// Adiabatic.
    Insulated,
    /// Convective: a fixed temperature, deg C, behind a film coefficient, W/(m2 K); infinite for an isothermal back.
    Film {
        /// Film coefficient, W/(m2 K).
        film_w_m2k: f64,
        /// Temperature behind the film, deg C.
        temperature_c: f64,
    },
}

/// A meshed slab, cells ordered from the surface; all quantities per square metre.
#[derive(Clone, Debug, PartialEq)]
pub struct Slab {
    /// Heat capacity of each cell, J/(m2 K).
    pub capacity_j_m2k: Vec<f64>,
    /// Conductance from each node to the next deeper one, W/(m2 K).
    pub link_w_m2k: Vec<f64>,
    /// Resistance from the surface to the first node, m2 K/W.
    pub surface_m2k_w: f64,
    /// Conductance from the last node through the back, W/(m2 K), and temperature behind it, deg C.
    pub back: (f64, f64),
    /// Exchange coefficient of each cell with blood at full flow, W/(m2 K).
    pub blood_w_m2k: Vec<f64>,
    /// Metabolic heat of each cell, W/m2.
    pub metabolism_w_m2: Vec<f64>,
    /// Depth of each node, m.
    pub depth_m: Vec<f64>,
}

/// Half-spaces are meshed for at least this simulated time, s, so that they contain the receptors.
const SHORTEST_S: f64 = 1.0;
/// Depth of a perfused half-space in decay lengths of its steady state: `exp(-12)` is 6e-6.
const STEADY_STATE_LENGTHS: f64 = 12.0;

impl Slab {
    /// Meshes one or more layers for a simulated time of `duration_s`.
    pub fn new(layers: &[Layer], back: BackBoundary, duration_s: f64, grading: &Grading) -> Self {
        let mut slab = Self {
            capacity_j_m2k: Vec::new(),
            link_w_m2k: Vec::new(),
            surface_m2k_w: 0.0,
            back: (0.0, 0.0),
            blood_w_m2k: Vec::new(),
            metabolism_w_m2: Vec::new(),
            depth_m: Vec::new(),
        };
        // Width of the next cell in diffusion lengths, depth of its face, and resistance from the node before to it.
        let (mut next, mut face_m, mut behind_m2k_w) = (grading.first, 0.0, 0.0);
        for Layer { thickness_m, medium } in layers {
            let k = medium.conductivity_w_mk;
            let a = medium.diffusivity_m2_s();
            let thickness_m = if thickness_m.is_finite() {
                *thickness_m
            } else {
                let diffusion_m = grading.depth * (a * duration_s.max(SHORTEST_S)).sqrt();
                // The steady state decays with depth over the length sqrt(k/perfusion).
                let steady_state_m = if medium.perfusion_w_m3k > 0.0 {
                    STEADY_STATE_LENGTHS * (k / medium.perfusion_w_m3k).sqrt()
                } else {
                    0.0
                };
                diffusion_m.max(steady_state_m)
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
                slab.capacity_j_m2k.push(medium.capacity_j_m3k * cell.width_m);
                slab.blood_w_m2k.push(medium.perfusion_w_m3k * cell.width_m);
                slab.metabolism_w_m2.push(medium.metabolism_w_m3 * cell.width_m);
                behind_m2k_w = (cell.width_m - cell.node_m) / k;
                face_m += cell.width_m;
                next = cell.width_m * grading.growth / a.sqrt();
            }
        }
        if let BackBoundary::Film { film_w_m2k, temperature_c } = back {
            slab.back = (1.0 / (behind_m2k_w + 1.0 / film_w_m2k), temperature_c);
        }
        slab
    }

    /// Number of cells, at least 1.
    pub fn cells(&self) -> usize {
        self.capacity_j_m2k.len()
    }
}

#[cfg(test)]
mod tests;

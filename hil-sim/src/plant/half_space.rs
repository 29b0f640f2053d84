//! A body that heat enters through one plane surface and that is deep enough never to warm at its back.
//!
//! Finite volumes per square metre of surface, growing with depth. What happens a time `t` after a contact happens
//! within a few diffusion lengths `sqrt(a t)`, so such a mesh resolves every time alike.

use contact_model::material::Material;

use super::chain::Link;

/// Width of the first cell in diffusion lengths of one second, s^1/2: the length of 16 us.
const FIRST_CELL: f64 = 0.004;
/// Each cell against the one before it. The error of a surface temperature falls with the square of its excess
/// over 1; here it is 0.7 mK for a contact of 10 K.
const GROWTH: f64 = 1.06;
/// Depth in diffusion lengths of the whole duration. The surface notices the insulated back by way of twice that,
/// as `erfc(4) = 1.5e-8` of a step.
const DEPTH: f64 = 4.0;

/// A half-space cut into cells, the surface first.
#[derive(Clone, Debug)]
pub struct HalfSpace {
    /// Heat capacity of each cell, J/(m2 K).
    pub capacity_j_m2k: Vec<f64>,
    /// From each cell to the next deeper one, W/(m2 K).
    pub links: Vec<Link>,
    /// From the surface to the middle of the first cell, m2 K/W.
    pub half_cell_m2k_w: f64,
}

impl HalfSpace {
    /// Cells for a body of one material whose surface is watched for `duration_s`.
    #[must_use]
    pub fn new(material: &Material, duration_s: f64) -> Self {
        let k = material.surface.conductivity_w_mk;
        let a = material.diffusivity_m2_s();
        let width_m = widths_m(FIRST_CELL * a.sqrt(), DEPTH * (a * duration_s).sqrt());
        Self {
            capacity_j_m2k: width_m
                .iter()
                .map(|w| material.volumetric_heat_j_m3k() * w)
                .collect(),
            links: width_m
                .windows(2)
                .map(|w| Link::symmetric(2.0 * k / (w[0] + w[1])))
                .collect(),
            half_cell_m2k_w: width_m[0] / (2.0 * k),
        }
    }

    /// Number of cells, at least one.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.capacity_j_m2k.len()
    }
}

/// Widths of cells from the surface down to the given depth or just beyond it.
fn widths_m(first_m: f64, depth_m: f64) -> Vec<f64> {
    let mut width_m = vec![first_m];
    let mut reached_m = first_m;
    while reached_m < depth_m {
        let next_m = width_m[width_m.len() - 1] * GROWTH;
        width_m.push(next_m);
        reached_m += next_m;
    }
    width_m
}

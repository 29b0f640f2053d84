//! Lateral zones of a plate, approximated by a disc of equal area: the patch under the finger in the middle, and rings
//! around it.

use std::f64::consts::PI;

use super::params::TileParams;

/// The patch and two rings.
pub const ZONES: usize = 3;

/// Areas of the zones and shape factors of the conduction between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zones {
    /// Area of each zone, m2.
    pub area_m2: [f64; ZONES],
    /// Conductance between the mean temperatures of each zone and the next, divided by conductivity and thickness of the
    /// sheet; 0 for the last zone.
    pub shape: [f64; ZONES],
}

impl Zones {
    /// The zones of a tile's plates.
    pub fn new(params: &TileParams) -> Self {
        let radius_m = |m2: f64| (m2 / PI).sqrt();
        let (inner_m, outer_m) = (radius_m(params.patch_m2), radius_m(params.plate_m2()));
        // The radii grow by a constant factor.
        let factor = (outer_m / inner_m).powf(1.0 / (ZONES - 1) as f64);
        let edge_m: [f64; ZONES] = std::array::from_fn(|z| inner_m * factor.powi(z as i32));
        // The mean temperature of a ring is about that at the radius which halves its area. That of a disc with a uniform
        // load differs from that of its edge by 1/(8 pi) times power over sheet conductance.
        let inward = |z: usize| match z {
            0 => 1.0 / (8.0 * PI),
            _ => (edge_m[z] / middle_m(edge_m[z - 1], edge_m[z])).ln() / (2.0 * PI),
        };
        let outward =
            |z: usize| (middle_m(edge_m[z - 1], edge_m[z]) / edge_m[z - 1]).ln() / (2.0 * PI);
        Self {
            area_m2: std::array::from_fn(|z| {
                let hole_m = if z > 0 { edge_m[z - 1] } else { 0.0 };
                PI * (edge_m[z].powi(2) - hole_m.powi(2))
            }),
            shape: std::array::from_fn(|z| {
                if z + 1 < ZONES { 1.0 / (inward(z) + outward(z + 1)) } else { 0.0 }
            }),
        }
    }
}

/// Radius that halves the area of a ring.
fn middle_m(inner_m: f64, outer_m: f64) -> f64 {
    (0.5 * (inner_m.powi(2) + outer_m.powi(2))).sqrt()
}

//! The electrical analogy: finger and object as ladders of resistors and capacitors, joined by a contact resistance.
//!
//! ```text
//! skin   o--R/2--+--R--+-- ... --+      object   o--R/2--+--R--+-- ... --+
//!        |       C     C         C               |       C     C         C
//!        '------------- contact resistance ------'
//! ```

use contact_model::material::{Material, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::contact_resistance;
use thermal_client::course::Course;
use thermal_plant::slab::{Slab, SlabBatch};

use crate::touch::{STEP_S, SingleContact};

/// Depth of a ladder in diffusion lengths `sqrt(alpha t)` of the contact.
const DEPTH: f64 = 3.0;
/// Parts of the first step, in which temperatures change most.
const FIRST_PARTS: u32 = 128;

/// Two ladders of equal cells, as deep as heat diffuses during the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RcLadder {
    /// Number of cells, each a resistor and a capacitor, of finger and of object; at least 1.
    pub order: u32,
}

impl RcLadder {
    /// Surface temperature of the skin, °C. At the landing only the resistors divide the difference of skin and object.
    pub fn skin(&self, touch: &SingleContact) -> Course {
        let resistance_m2k_w: f64 =
            contact_resistance(&SKIN.surface, &touch.object.surface, pressure_pa(touch.force_n));
        let ladders =
            [self.ladder(&SKIN, touch.contact_s), self.ladder(&touch.object, touch.contact_s)];
        let halves_m2k_w = [0, 1].map(|side| ladders[side].surface_m2k_w);
        let link_w_m2k = 1.0 / (halves_m2k_w[0] + resistance_m2k_w + halves_m2k_w[1]);
        let lengths_s = [STEP_S, STEP_S / f64::from(FIRST_PARTS)];
        let [skin, object] = &ladders;
        let mut cells = SlabBatch::new([skin, object], [touch.skin_c, touch.object_c], &lengths_s);
        touch.sampled(|t_s| {
            if t_s > 0.0 {
                let (parts, length) = if t_s < 1.5 * STEP_S { (FIRST_PARTS, 1) } else { (1, 0) };
                for _ in 0..parts {
                    step(&mut cells, length, link_w_m2k);
                }
            }
            let out_w_m2 = link_w_m2k * (cells.surface_c(0) - cells.surface_c(1));
            cells.surface_c(0) - out_w_m2 * halves_m2k_w[0]
        })
    }

    fn ladder(&self, material: &Material, contact_s: f64) -> Slab {
        let cells = self.order.max(1) as usize;
        let depth_m = DEPTH * (material.diffusivity_m2_s() * contact_s).sqrt();
        let width_m = depth_m / cells as f64;
        let resistance_m2k_w = width_m / material.surface.conductivity_w_mk;
        Slab {
            capacity_j_m2k: vec![material.volumetric_heat_j_m3k() * width_m; cells],
            link_w_m2k: vec![1.0 / resistance_m2k_w; cells - 1],
            surface_m2k_w: 0.5 * resistance_m2k_w,
            back: (0.0, 0.0),
            blood_w_m2k: vec![0.0; cells],
            metabolism_w_m2: vec![0.0; cells],
            depth_m: (0..cells).map(|i| (i as f64 + 0.5) * width_m).collect(),
        }
    }
}

/// A step of both ladders, whose first nodes a conductance joins.
fn step(cells: &mut SlabBatch<2>, length: usize, link_w_m2k: f64) {
    let out_w_m2 = link_w_m2k * (cells.surface_c(0) - cells.surface_c(1));
    let equations = cells.first_stage(length, [-out_w_m2, out_w_m2]);
    let increments = joined(equations.map(|e| (e.pivot, e.rhs)), link_w_m2k);
    let equations = cells.second_stage(length, increments);
    let increments = joined(equations.map(|e| (e.pivot, e.rhs)), link_w_m2k);
    cells.finish_step(length, increments);
}

/// Increments of two surface nodes from pivot and right-hand side of each, by Cramer's rule.
fn joined([a, b]: [(f64, f64); 2], link_w_m2k: f64) -> [f64; 2] {
    let determinant = a.0 * b.0 + link_w_m2k * (a.0 + b.0);
    let shared = link_w_m2k * (a.1 + b.1);
    [(a.1 * b.0 + shared) / determinant, (b.1 * a.0 + shared) / determinant]
}

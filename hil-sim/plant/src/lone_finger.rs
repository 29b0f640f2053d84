//! A finger alone, on a surface whose temperature is given, or on an object: what the plant's finger does without tile and
//! electronics, with the plant's slabs and time integration.

use super::STEP_S;
use super::finger::FingerParams;
use super::object::ObjectConfig;
use super::slab::{Grading, Slab, SlabBatch, steady_state};

/// Parts of the first step, in which temperatures change most.
const FIRST_PARTS: u32 = 128;
/// Lengths of step, s, and their indices.
const LENGTHS_S: [f64; 2] = [STEP_S, STEP_S / FIRST_PARTS as f64];
const WHOLE: usize = 0;
const PART: usize = 1;

/// A finger before its contact.
#[derive(Clone, Debug, PartialEq)]
pub struct LoneFinger {
    /// Its parameters. Surface, factor on the contact resistance and vessels are not used: the caller states resistance and flow.
    pub params: FingerParams,
    /// Blood flow in contact as a fraction of the full flow, which it has before.
    pub flow: f64,
    /// Its surface, deg C.
    pub skin_c: f64,
    /// The air around it, deg C.
    pub room_c: f64,
}

/// Course of a contact at the landing and after each step of [`STEP_S`].
#[derive(Clone, Debug, PartialEq)]
pub struct ContactCourse {
    /// Surface of the skin, deg C.
    pub skin_c: Vec<f64>,
    /// Heat flux out of it, W/m2.
    pub flux_w_m2: Vec<f64>,
}

impl LoneFinger {
    /// Contact through a resistance, m2 K/W, with a surface of a temperature, deg C, at each time since the landing, s.
    pub fn on_surface(
        &self,
        contact_m2k_w: f64,
        steps: u32,
        surface_c: &dyn Fn(f64) -> f64,
    ) -> ContactCourse {
        let slab = self.slab(steps);
        let mut skin = SlabBatch::new([&slab], [self.skin_c], &LENGTHS_S);
        self.start(&slab, &mut skin);
        let g = 1.0 / (slab.surface_m2k_w + contact_m2k_w);
        let mut course = ContactCourse {
            skin_c: vec![self.skin_c],
            flux_w_m2: vec![(self.skin_c - surface_c(0.0)) / contact_m2k_w],
        };
        each_part(steps, |from_s, length, ends_step| {
            let other_c = surface_c(from_s + 0.5 * LENGTHS_S[length]);
            let into_w_m2 = g * (other_c - skin.surface_c(0));
            let [equation] = skin.first_stage(length, [into_w_m2]);
            let increment = equation.rhs / (equation.pivot + g);
            let [equation] = skin.second_stage(length, [increment]);
            let increment = equation.rhs / (equation.pivot + g);
            skin.finish_step(length, [increment]);
            if ends_step {
                let end_s = from_s + LENGTHS_S[length];
                let flux_w_m2 = g * (skin.surface_c(0) - surface_c(end_s));
                course.push(&slab, skin.surface_c(0), flux_w_m2);
            }
        });
        course
    }

    /// Contact through a resistance, m2 K/W, with an object.
    pub fn on_object(
        &self,
        contact_m2k_w: f64,
        steps: u32,
        object: &ObjectConfig,
    ) -> ContactCourse {
        let slab = self.slab(steps);
        let duration_s = f64::from(steps) * STEP_S;
        let other = Slab::new(&object.layers, object.back, duration_s, &Grading::STANDARD);
        let mut both = SlabBatch::new([&slab, &other], [self.skin_c, object.start_c], &LENGTHS_S);
        self.start(&slab, &mut both);
        let g = 1.0 / (slab.surface_m2k_w + contact_m2k_w + other.surface_m2k_w);
        let mut course = ContactCourse {
            skin_c: vec![self.skin_c],
            flux_w_m2: vec![(self.skin_c - object.start_c) / contact_m2k_w],
        };
        each_part(steps, |_, length, ends_step| {
            let out_w_m2 = g * (both.surface_c(0) - both.surface_c(1));
            let solve = |equations: [super::slab::SurfaceEquation; 2]| {
                let [a, b] = equations.map(|equation| equation.pivot + g);
                let [rhs_a, rhs_b] = equations.map(|equation| equation.rhs);
                let determinant = a * b - g * g;
                [(b * rhs_a + g * rhs_b) / determinant, (a * rhs_b + g * rhs_a) / determinant]
            };
            let increments = solve(both.first_stage(length, [-out_w_m2, out_w_m2]));
            let increments = solve(both.second_stage(length, increments));
            both.finish_step(length, increments);
            if ends_step {
                let flux_w_m2 = g * (both.surface_c(0) - both.surface_c(1));
                course.push(&slab, both.surface_c(0), flux_w_m2);
            }
        });
        course
    }

    fn slab(&self, steps: u32) -> Slab {
        let duration_s = f64::from(steps) * STEP_S;
        let FingerParams { layers, .. } = &self.params;
        Slab::new(layers, self.params.back(), duration_s, &Grading::STANDARD)
    }

    /// Sets the first slab to the steady state before contact, and the flow to that in contact.
    fn start<const L: usize>(&self, slab: &Slab, slabs: &mut SlabBatch<L>) {
        let loss_w_m2 = self.params.air_w_m2k * (self.skin_c - self.room_c);
        if let Some(steady) = steady_state(slab, self.skin_c, loss_w_m2) {
            for (node, celsius) in steady.node_c.iter().enumerate() {
                slabs.set_node_c(0, node, *celsius);
            }
            slabs.set_core_c(0, steady.core_c);
        }
        slabs.set_flow(0, self.flow);
    }
}

impl ContactCourse {
    /// Appends the end of a step by the temperature of the finger's first node, deg C, and the flux, W/m2.
    fn push(&mut self, finger: &Slab, node_c: f64, flux_w_m2: f64) {
        self.skin_c.push(node_c - flux_w_m2 * finger.surface_m2k_w);
        self.flux_w_m2.push(flux_w_m2);
    }
}

/// Calls `part` with the start, s, of each part of each step, the index of its length, and whether it ends the step.
fn each_part(steps: u32, mut part: impl FnMut(f64, usize, bool)) {
    for step in 0..steps {
        let (parts, length) = if step == 0 { (FIRST_PARTS, PART) } else { (1, WHOLE) };
        for number in 0..parts {
            let from_s = f64::from(step) * STEP_S + f64::from(number) * LENGTHS_S[PART];
            part(from_s, length, number + 1 == parts);
        }
    }
}

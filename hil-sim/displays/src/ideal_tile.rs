//! The finger on a tile that follows its course exactly.

use thermal_client::course::Course;
use thermal_plant::ConfigError;
use thermal_plant::slab::{Grading, Slab, SlabBatch, steady_state};

use crate::touch::{STEP_S, SingleContact};

/// Parts of the first step, in which temperatures change most.
const FIRST_PARTS: u32 = 128;
/// Indices of the lengths of step.
const WHOLE: usize = 0;
const PART: usize = 1;

/// Surface temperature of the skin, °C, at the landing and after each step of 1 ms: the scene's finger, touching with the
/// plant's contact resistance a surface whose temperature is the course. Temperatures are as in the plant, whose slabs and
/// time integration these are; the surface has its mean temperature of each step.
///
/// # Errors
/// The scene's plant does not accept a value.
pub fn skin_on_ideal_tile(touch: &SingleContact, course: &Course) -> Result<Vec<f64>, ConfigError> {
    touch.plant.check()?;
    let params = &touch.plant.params;
    let finger = &params.finger;
    let slab = Slab::new(
        &finger.layers,
        finger.back(),
        touch.contact_s,
        &Grading::STANDARD,
    );
    let lengths_s = [STEP_S, STEP_S / f64::from(FIRST_PARTS)];
    let mut skin = SlabBatch::new([&slab], [touch.skin_c], &lengths_s);
    let loss_w_m2 = finger.air_w_m2k * (touch.skin_c - touch.plant.room_c);
    if let Some(steady) = steady_state(&slab, touch.skin_c, loss_w_m2) {
        for (node, celsius) in steady.node_c.iter().enumerate() {
            skin.set_node_c(0, node, *celsius);
        }
        skin.set_core_c(0, steady.core_c);
    }
    if let Some(vessels) = finger.vessels {
        skin.set_flow(0, vessels.flow(touch.force_n));
    }
    let contact = (params.contact).at_force(touch.force_n, &finger.surface, &params.display);
    let contact_w_m2k = contact.map_or(0.0, |contact| {
        1.0 / (slab.surface_m2k_w + finger.resistance_factor * contact.resistance_m2k_w)
    });
    let mut skin_c = vec![touch.skin_c];
    for step in 0..touch.steps() {
        let (parts, length) = if step == 0 {
            (FIRST_PARTS, PART)
        } else {
            (1, WHOLE)
        };
        for part in 0..parts {
            let from_s = f64::from(step) * STEP_S + f64::from(part) * lengths_s[PART];
            let surface_c = course.at(from_s + 0.5 * lengths_s[length]);
            let into_w_m2 = contact_w_m2k * (surface_c - skin.surface_c(0));
            let [equation] = skin.first_stage(length, [into_w_m2]);
            let increment = equation.rhs / (equation.pivot + contact_w_m2k);
            let [equation] = skin.second_stage(length, [increment]);
            let increment = equation.rhs / (equation.pivot + contact_w_m2k);
            skin.finish_step(length, [increment]);
        }
        let surface_c = course.at(f64::from(step + 1) * STEP_S);
        let out_w_m2 = contact_w_m2k * (skin.surface_c(0) - surface_c);
        skin_c.push(skin.surface_c(0) - out_w_m2 * slab.surface_m2k_w);
    }
    Ok(skin_c)
}

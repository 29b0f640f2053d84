//! The components of the finger's weights are those of the simulator's fingers.

use contact_model::finger::{COMPONENT_MEANS, COMPONENTS};
use relaxation_fit::{Back, Layer, components, impedance};
use thermal_plant::finger::FingerParams;
use thermal_plant::parameters::draw_finger;

const FINGERS: u64 = 600;

/// Surface impedance of a drawn finger under the force of a firm contact, m² K/W.
fn drawn(seed: u64) -> impl Fn(f64) -> f64 {
    let mut finger = FingerParams::layered();
    draw_finger(&mut finger, seed, true);
    // Where force stops the blood, none flows from 1.2 N on.
    let flow = finger.vessels.map_or(1.0, |vessels| vessels.flow(2.0));
    let layer = |layer: &thermal_plant::slab::Layer| Layer {
        thickness_m: layer.thickness_m,
        conductivity_w_mk: layer.medium.conductivity_w_mk,
        capacity_j_m3k: layer.medium.capacity_j_m3k,
        perfusion_w_m3k: layer.medium.perfusion_w_m3k * flow,
    };
    let layers: Vec<_> = finger.layers.iter().map(layer).collect();
    move |s_1_s| impedance(&layers, Back::Held, s_1_s)
}

#[test]
fn committed_components_are_those_of_the_drawn_fingers() {
    let found = components(&(0..FINGERS).map(drawn).collect::<Vec<_>>());
    println!("{found:#.4?}");
    let committed = COMPONENTS.iter().flatten().chain(&COMPONENT_MEANS);
    let computed = found.weights.iter().flatten().chain(&found.means);
    for (committed, computed) in committed.zip(computed) {
        assert!((committed - computed).abs() <= 5.1e-5, "{committed}, not {computed}");
    }
    // As the documentation of the constants states them.
    let errors = found.errors.map(|error| (error * 1e3).round());
    assert_eq!(errors, [154.0, 11.0, 3.0]);
    assert!(found.least_weight > 0.67, "{}", found.least_weight);
}

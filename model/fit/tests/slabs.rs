//! Slabs in closed form against their exact impedance.

use contact_model::fixed_point::Body;
use contact_model::material::{MATERIALS, SKIN};
use contact_model::slab::{Back, Slab};
use relaxation_fit::{Layer, impedance};

/// The measure is the error of the skin's temperature, K, that the error of the impedance causes in a contact with a
/// difference of 10 K at 2 N, at Laplace variables from 0.1 to 300 1/s (times of 3 ms to 10 s).
#[test]
fn closed_form_of_slabs_gives_their_impedance() {
    let (mut worst_k, mut fast, mut slow) = (0f64, 0, 0);
    for (name, material) in MATERIALS {
        for thickness_m in [0.5e-3, 1e-3, 2e-3, 3e-3, 5e-3, 10e-3, 20e-3, 50e-3] {
            for back in [Back::Insulated, Back::Held, Back::Film(10.0)] {
                let (conductivity_w_mk, capacity_j_m3k) =
                    (material.surface.conductivity_w_mk, material.volumetric_heat_j_m3k());
                let layer =
                    Layer { thickness_m, conductivity_w_mk, capacity_j_m3k, perfusion_w_m3k: 0.0 };
                let slab =
                    Slab { thickness_m, conductivity_w_mk, capacity_j_m3k, back }.relaxations();
                Body::new(&slab.impedance(), SKIN.effusivity(), 1e-3)
                    .unwrap_or_else(|error| panic!("{name} {thickness_m} {back:?}: {error}"));
                let resistance = contact_model::reference::contact_resistance(
                    &SKIN.surface,
                    &material.surface,
                    contact_model::pressure::pressure_pa(2.0),
                );
                for i in 0..60 {
                    let s = 0.1 * 10f64.powf(f64::from(i) / 17.0);
                    let zf = 1.0 / (SKIN.effusivity() * s.sqrt());
                    let exact = impedance(&[layer], back, s);
                    let error = slab.impedance().at(s) - exact;
                    let error_k = (10.0 * zf / (zf + resistance + exact).powi(2) * error).abs();
                    worst_k = worst_k.max(error_k);
                    if error_k > 10e-3 {
                        println!("{name} {thickness_m} {back:?} at {s}: {error_k}");
                    }
                }
                let relaxations = slab.impedance();
                let count =
                    relaxations.relaxations.iter().filter(|one| one.rate_1_s >= 12.5).count();
                fast = fast.max(count);
                slow = slow.max(relaxations.relaxations.len() - count);
            }
        }
    }
    println!("{:.2} mK, {fast} fast, {slow} slow", 1e3 * worst_k);
    assert!(worst_k < 15e-3, "{worst_k}");
}

//! The relaxations by which the host describes an object that is not a half-space.

use contact_model::material::{Material, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::contact_resistance;
use relaxation_fit::{Back, Fit, Layer, fit, impedance};
use thermal_plant::slab::{self, BackBoundary};

/// Largest number of relaxations that are fitted to an object.
const RELAXATIONS_MAX: usize = 14;
/// Force, N, for whose contact resistance the errors of the object's impedance are weighted.
const TYPICAL_FORCE_N: f64 = 2.0;

/// Fits relaxations to an object of these layers by least squares of the error that they cause in the skin's temperature.
/// `material` is that of the touched surface, which determines the contact resistance.
pub fn object_fit(material: &Material, layers: &[slab::Layer], back: &BackBoundary) -> Fit {
    let layers: Vec<_> = (layers.iter())
        .map(|layer| Layer {
            thickness_m: layer.thickness_m,
            conductivity_w_mk: layer.medium.conductivity_w_mk,
            capacity_j_m3k: layer.medium.capacity_j_m3k,
            perfusion_w_m3k: 0.0,
        })
        .collect();
    let back = match back {
        BackBoundary::Insulated => Back::Insulated,
        BackBoundary::Film { film_w_m2k, .. } => Back::Film(*film_w_m2k),
    };
    let pressure = pressure_pa(TYPICAL_FORCE_N);
    let resistance_m2k_w = contact_resistance(&SKIN.surface, &material.surface, pressure);
    // Error of the skin's temperature per error of the object's impedance, in a contact with a difference of 1 K.
    let weight = |s_1_s: f64, object_m2k_w: f64| {
        let skin_m2k_w = 1.0 / (SKIN.effusivity() * s_1_s.sqrt());
        skin_m2k_w / (skin_m2k_w + resistance_m2k_w + object_m2k_w).powi(2)
    };
    fit(|s_1_s| impedance(&layers, back, s_1_s), weight, RELAXATIONS_MAX)
}

//! Relaxations of the fingers that the device may assume.

use contact_model::material::SKIN;

use crate::{Back, Fit, Layer, fit, impedance};

/// Most relaxations of a finger.
const RELAXATIONS_MAX: usize = 9;

fn fit_relative(layers: &[Layer], back: Back) -> Fit {
    fit(|s| impedance(layers, back, s), |_, z| 1.0 / z, RELAXATIONS_MAX)
}

/// The thesis's finger: a half-space of skin.
pub fn thesis() -> Fit {
    let skin =
        without_blood(f64::INFINITY, SKIN.surface.conductivity_w_mk, SKIN.volumetric_heat_j_m3k());
    fit_relative(&[skin], Back::Insulated)
}

const fn without_blood(thickness_m: f64, conductivity_w_mk: f64, capacity_j_m3k: f64) -> Layer {
    Layer { thickness_m, conductivity_w_mk, capacity_j_m3k, perfusion_w_m3k: 0.0 }
}

/// The mean finger's epidermis, dermis and fat, without blood, which a touch of 1 N or more stops.
pub const MEAN_LAYERS: [Layer; 3] = [
    without_blood(0.65e-3, 0.21, 1110.0 * 3600.0),
    without_blood(1.2e-3, 0.37, 1116.0 * 3224.0),
    without_blood(4.0e-3, 0.16, 970.0 * 2303.0),
];

/// The mean finger: its layers over a core that keeps its temperature.
pub fn mean() -> Fit {
    fit_relative(&MEAN_LAYERS, Back::Held)
}

//! Relaxations of the fingers that the device may assume.

use contact_model::material::SKIN;

use crate::{Back, Fit, Layer, fit, impedance};

/// Most relaxations of a finger.
const RELAXATIONS_MAX: usize = 9;

fn fit_relative(layers: &[Layer], back: Back) -> Fit {
    fit(
        |s| impedance(layers, back, s),
        |_, z| 1.0 / z,
        RELAXATIONS_MAX,
    )
}

/// The thesis's finger: a half-space of skin.
#[must_use]
pub fn thesis() -> Fit {
    let skin = Layer {
        thickness_m: f64::INFINITY,
        conductivity_w_mk: SKIN.surface.conductivity_w_mk,
        capacity_j_m3k: SKIN.volumetric_heat_j_m3k(),
        perfusion_w_m3k: 0.0,
    };
    fit_relative(&[skin], Back::Insulated)
}

/// The mean finger: epidermis, dermis and fat over a core, without blood, which a touch of 1 N or more stops.
#[must_use]
pub fn mean() -> Fit {
    let layer = |thickness_m, conductivity_w_mk, capacity_j_m3k| Layer {
        thickness_m,
        conductivity_w_mk,
        capacity_j_m3k,
        perfusion_w_m3k: 0.0,
    };
    let layers = [
        layer(0.65e-3, 0.21, 1110.0 * 3600.0),
        layer(1.2e-3, 0.37, 1116.0 * 3224.0),
        layer(4.0e-3, 0.16, 970.0 * 2303.0),
    ];
    fit_relative(&layers, Back::Held)
}

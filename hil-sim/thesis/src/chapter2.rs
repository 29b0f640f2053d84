//! Section 2.1: the skin.

use contact_model::material::SKIN;

use super::row::Row;
use super::stated::printed;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::new(
            "Section 2.1",
            "skin, conductivity",
            "W/(m K)",
            printed(0.37, 2),
            SKIN.surface.conductivity_w_mk,
        ),
        Row::new(
            "Section 2.1",
            "skin, diffusivity",
            "1e-7 m²/s",
            printed(1.0, 0),
            SKIN.diffusivity_m2_s() * 1e7,
        ),
    ]
}

//! Chapter 4: Table 4-1 and the interface temperatures of section 4.2.3.
//!
//! The labels of Table 4-1 are shifted by one row: what it calls density is conductivity, and so on.

use contact_model::material::{Material, SKIN, Surface};
use contact_model::reference::interface_temperature;
use experiment_statistics::search::bisect;

use super::contact_case::material;
use super::statement::Statement;

/// Initial temperatures of skin and material in chapter 4, °C (section 4.1).
const BEFORE_C: (f64, f64) = (34.0, 23.5);

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    let (skin_c, object_c) = BEFORE_C;
    let interface = |name: &str| interface_temperature(&SKIN, skin_c, &material(name), object_c);
    Some(match quantity {
        "interface" => interface(&statement.of),
        // The cold group is copper to granite, the neutral group ABS to foam.
        "range of the cold group" => interface("granite") - interface("copper"),
        "range of the neutral group" => interface("foam") - interface("ABS"),
        "distance of the groups" => interface("ABS") - interface("granite"),
        "contact coefficient that gives {} °C" => effusivity_at(statement.given()),
        _ => return None,
    })
}

/// Effusivity at which Eq. 3-1 gives the interface temperature, J/(m² s^½ K).
fn effusivity_at(interface_c: f64) -> f64 {
    let (skin_c, object_c) = BEFORE_C;
    let fall = |effusivity: f64| {
        let object = Material {
            surface: Surface { conductivity_w_mk: effusivity, ..SKIN.surface },
            density_kg_m3: effusivity,
            specific_heat_j_kgk: 1.0,
        };
        skin_c - interface_temperature(&SKIN, skin_c, &object, object_c)
    };
    bisect(fall, skin_c - interface_c, 0.0, 1e6)
}

//! Chapter 4: Table 4-1, the interface temperatures of section 4.2.3, and the opening of section 4.3.1.

use contact_model::material::{Material, SKIN, Surface};
use contact_model::reference::interface_temperature;

use super::case::{Sample, five, sample, tabulated_effusivity};
use super::root::bisect;
use super::row::{Correction, Row};
use super::stated::{Stated, printed};

/// Skin and material that the display of chapter 4 starts from, °C (section 4.1).
const BEFORE_C: (f64, f64) = (34.0, 23.5);

pub(super) fn rows() -> Vec<Row> {
    let opening = opening("Section 4.3.1", 7.0, 10.0, printed(220.0, 0));
    [table_4_1(), interface_temperatures(), vec![opening]].concat()
}

/// The labels of Table 4-1 are shifted by one row: what it calls density is conductivity, and so on.
fn table_4_1() -> Vec<Row> {
    let decimals = [0, 1, 2, 2, 3];
    let finish = [
        (0.31, 0.045),
        (0.19, 0.031),
        (0.46, 0.048),
        (0.45, 0.046),
        (8.03, 0.157),
    ];
    let conductivities = [398.0, 13.5, 2.79, 0.18, 0.029];
    let densities = [8954.0, 8000.0, 2630.0, 1010.0, 24.0];
    let specific_heats = [384.0, 460.0, 775.0, 1386.0, 1210.0];
    let effusivities = [36992.0, 7048.0, 2384.0, 501.0, 29.0];
    let (skin_c, object_c) = BEFORE_C;
    let mut rows = Vec::new();
    for (i, Sample { name, material }) in five().into_iter().enumerate() {
        let row = |what: &str, unit, stated, computed| {
            Row::new(
                "Table 4-1",
                format!("{name}, {what}"),
                unit,
                stated,
                computed,
            )
        };
        let shifted = |row: Row, holds: &str, value| {
            row.damaged(
                format!("labels shifted by one row: holds the {holds}"),
                Correction::Is(value),
            )
        };
        rows.extend([
            shifted(
                row(
                    "density",
                    "kg/m³",
                    printed(conductivities[i], decimals[i]),
                    material.density_kg_m3,
                ),
                "conductivity",
                material.surface.conductivity_w_mk,
            ),
            shifted(
                row(
                    "specific heat",
                    "J/(kg K)",
                    printed(densities[i], 0),
                    material.specific_heat_j_kgk,
                ),
                "density",
                material.density_kg_m3,
            ),
            shifted(
                row(
                    "contact coefficient",
                    "J/(m² s^½ K)",
                    printed(specific_heats[i], 0),
                    material.effusivity(),
                ),
                "specific heat",
                material.specific_heat_j_kgk,
            ),
            shifted(
                row(
                    "interface",
                    "°C",
                    printed(effusivities[i], 0),
                    interface_temperature(&SKIN, skin_c, &material, object_c),
                ),
                "contact coefficient, cut",
                tabulated_effusivity(&material),
            ),
            row(
                "Rq",
                "µm",
                printed(finish[i].0, 2),
                material.surface.roughness_um,
            ),
            row(
                "asperity slope",
                "rad",
                printed(finish[i].1, 3),
                material.surface.slope_rad,
            ),
        ]);
    }
    rows
}

/// Section 4.2.3: the cold group, the neutral group, and the boundary between them.
fn interface_temperatures() -> Vec<Row> {
    let (skin_c, object_c) = BEFORE_C;
    let interface = |key| interface_temperature(&SKIN, skin_c, &sample(key).material, object_c);
    let (copper, granite, abs, foam) = (
        interface("copper"),
        interface("granite"),
        interface("abs"),
        interface("foam"),
    );
    let row = |what: &str, unit, stated, computed| {
        Row::new("Section 4.2.3", what, unit, stated, computed)
    };
    vec![
        row("copper, interface", "°C", printed(23.8, 1), copper),
        row("granite, interface", "°C", printed(27.0, 0), granite),
        row("ABS, interface", "°C", printed(30.8, 1), abs),
        row("foam, interface", "°C", printed(33.7, 1), foam),
        row(
            "range of the cold group",
            "K",
            printed(3.0, 0),
            granite - copper,
        ),
        row(
            "range of the neutral group",
            "K",
            printed(3.0, 0),
            foam - abs,
        ),
        row(
            "distance of the groups",
            "K",
            printed(4.0, 0),
            abs - granite,
        ),
        row(
            "contact coefficient that gives 30.8 °C",
            "J/(m² s^½ K)",
            printed(513.0, 0),
            effusivity_at(30.8),
        ),
        row(
            "contact coefficient that gives 27 °C",
            "J/(m² s^½ K)",
            printed(2340.0, 0),
            effusivity_at(27.0),
        ),
    ]
}

/// The effusivity with which Eq. 3-1 gives that interface temperature.
fn effusivity_at(interface_c: f64) -> f64 {
    let (skin_c, object_c) = BEFORE_C;
    let fall = |effusivity: f64| {
        let object = Material {
            surface: Surface {
                conductivity_w_mk: effusivity,
                ..SKIN.surface
            },
            density_kg_m3: effusivity,
            specific_heat_j_kgk: 1.0,
        };
        skin_c - interface_temperature(&SKIN, skin_c, &object, object_c)
    };
    bisect(fall, skin_c - interface_c, 0.0, 1e6)
}

/// Area of an elliptic opening.
pub(super) fn opening(place: &'static str, a_mm: f64, b_mm: f64, stated: Stated) -> Row {
    let ellipse = |a: f64, b: f64| std::f64::consts::PI * a * b;
    Row::new(
        place,
        format!("ellipse with axes of {a_mm} and {b_mm} mm"),
        "mm²",
        stated,
        ellipse(a_mm / 2.0, b_mm / 2.0),
    )
    .wrong(
        "the axes stated are semi-axes",
        Correction::Is(ellipse(a_mm, b_mm)),
    )
}

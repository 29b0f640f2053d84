//! Table 3-2: roughness and Young's modulus, and the strains of section 3.2.3.

use crate::case::{SIMULATION_AREA_M2, SIMULATION_PRESSURE_PA, sample};
use crate::row::{Correction, Row};
use crate::stated::{Stated, printed};

/// Material, roughness in µm and Young's modulus in GPa of Table 3-2; granite's modulus is Table 4-1's.
const TABLE_3_2: [(&str, f64, f64); 7] = [
    ("copper", 0.40, 110.0),
    ("bronze", 0.32, 93.0),
    ("stainless-steel", 0.43, 193.0),
    ("abs", 0.20, 2.3),
    ("g10", 1.50, 17.0),
    ("granite", 1.47, GRANITE_GPA),
    ("foam", 15.22, FOAM_GPA),
];
/// Young's modulus of granite, GPa (Table 4-1).
const GRANITE_GPA: f64 = 53.0;
/// Young's modulus of foam, GPa.
const FOAM_GPA: f64 = 1.5e-3;

/// Rq beside the one that chapter 6 computes with: Table 4-1's, where it has the material.
pub(super) fn table_3_2() -> Vec<Row> {
    let mut rows: Vec<Row> = TABLE_3_2
        .iter()
        .map(|&(key, roughness_um, _)| {
            let sample = sample(key);
            let row = Row::new(
                "Table 3-2",
                format!("{}, Rq", sample.name),
                "µm",
                printed(roughness_um, 2),
                sample.material.surface.roughness_um,
            );
            match key {
                "bronze" | "g10" => row.note("the thesis gives no asperity slope of it"),
                _ => row.note("Table 4-1 has the other value, and chapter 6 uses that"),
            }
        })
        .collect();
    rows.push(
        Row::new(
            "Table 3-2",
            "granite, Young's modulus",
            "GPa",
            Stated::Garbled("47 53"),
            GRANITE_GPA,
        )
        .damaged(
            "two numbers in one cell; Table 4-1 has the second",
            Correction::Reads(printed(53.0, 0)),
        ),
    );
    rows
}

/// Strains under the pressure of 2 N on 135 mm², and the area of three fingers.
pub(super) fn strains() -> Vec<Row> {
    let strain = |modulus_gpa: f64| SIMULATION_PRESSURE_PA / (modulus_gpa * 1e9);
    let solids = || {
        let solids = TABLE_3_2.iter().filter(|(key, ..)| *key != "foam");
        solids.map(|(_, _, modulus_gpa)| strain(*modulus_gpa))
    };
    let exponent = |value| Stated::About { value, within: 1.0 };
    vec![
        Row::new(
            "Section 3.2.3",
            "foam, strain",
            "",
            printed(0.01, 2),
            strain(FOAM_GPA),
        ),
        Row::new(
            "Section 3.2.3",
            "largest strain of the others, power of ten",
            "",
            exponent(-6.0),
            solids().fold(f64::MIN, f64::max).log10(),
        ),
        Row::new(
            "Section 3.2.3",
            "smallest strain of the others, power of ten",
            "",
            exponent(-7.0),
            solids().fold(f64::MAX, f64::min).log10(),
        ),
        Row::new(
            "Section 3.3.3",
            "contact area of three fingers",
            "mm²",
            printed(400.0, -2),
            3.0 * SIMULATION_AREA_M2 * 1e6,
        ),
    ]
}

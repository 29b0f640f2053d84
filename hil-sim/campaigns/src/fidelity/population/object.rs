//! Objects of finite thickness and of layers.

use std::fmt::Write;

use contact_model::material::{Material, THESIS_MATERIALS, find};

/// An object: what is touched, and what is behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyObject {
    /// Name in tables.
    pub name: String,
    /// The material that is touched.
    pub material: &'static str,
    /// The keys of the scene's `[object]` that describe the body; none of a half-space.
    pub keys: String,
}

/// Thicknesses of slabs, mm.
const THICKNESSES_MM: [f64; 8] = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0];
/// What is behind them: name, and keys of the scene.
const BACKS: [(&str, &str); 3] = [
    ("insulated", "back = \"insulated\"\n"),
    ("held", "back = \"held\"\n"),
    ("film 10", "back = \"film\"\nback_film_w_m2k = 10.0\n"),
];

/// Layers from the touched face down: material and thickness, mm; the last one may be endless.
type Layers = &'static [(&'static str, f64)];
const ENDLESS: f64 = f64::INFINITY;
/// Layered objects: name, layers, and what is behind them.
const LAYERED: [(&str, Layers, &str); 9] = [
    ("1 mm copper on foam", &[("copper", 1.0), ("foam", ENDLESS)], ""),
    ("0.1 mm copper on foam", &[("copper", 0.1), ("foam", ENDLESS)], ""),
    ("1 mm ABS on copper", &[("abs", 1.0), ("copper", ENDLESS)], ""),
    ("foam, copper, foam", &[("foam", 1.0), ("copper", 1.0), ("foam", ENDLESS)], ""),
    (
        "5 x copper, foam",
        &[
            ("copper", 0.2),
            ("foam", 0.5),
            ("copper", 0.2),
            ("foam", 0.5),
            ("copper", 0.2),
            ("foam", 0.5),
            ("copper", 0.2),
            ("foam", 0.5),
            ("copper", 0.2),
            ("foam", 0.5),
        ],
        BACKS[0].1,
    ),
    ("3 mm granite on foam", &[("granite", 3.0), ("foam", ENDLESS)], ""),
    ("0.5 mm foam on copper", &[("foam", 0.5), ("copper", ENDLESS)], ""),
    ("0.1 mm copper on ABS, film 10", &[("copper", 0.1), ("abs", 2.0)], BACKS[2].1),
    ("0.3 mm ABS on steel, held", &[("abs", 0.3), ("stainless-steel", 2.0)], BACKS[1].1),
];

/// 216 slabs, nine half-spaces and nine layered objects.
pub fn every_object() -> Vec<BodyObject> {
    let mut objects = Vec::new();
    for material in THESIS_MATERIALS {
        for thickness_mm in THICKNESSES_MM {
            objects.extend(BACKS.map(|back| slab(material, thickness_mm, back)));
        }
    }
    objects.extend(THESIS_MATERIALS.map(half_space));
    objects.extend(LAYERED.map(layered));
    objects
}

/// The objects of the finger's populations.
pub fn six_objects() -> [BodyObject; 6] {
    [
        half_space("copper"),
        half_space("granite"),
        half_space("abs"),
        half_space("foam"),
        slab("granite", 3.0, BACKS[0]),
        slab("copper", 3.0, BACKS[0]),
    ]
}

fn half_space(material: &'static str) -> BodyObject {
    BodyObject { name: material.into(), material, keys: String::new() }
}

fn slab(material: &'static str, thickness_mm: f64, (back, keys): (&str, &str)) -> BodyObject {
    BodyObject {
        name: format!("{material} {thickness_mm} mm {back}"),
        material,
        keys: format!("thickness_m = {:?}\n{keys}", thickness_mm * 1e-3),
    }
}

fn layered((name, layers, back): (&str, Layers, &str)) -> BodyObject {
    BodyObject {
        name: name.into(),
        material: layers.first().map_or("", |(material, _)| material),
        keys: back.to_owned() + &layer_keys(layers),
    }
}

/// The tables of a scene that describe layers, from the touched face down: material and thickness, mm; the last one may be
/// endless.
pub fn layer_keys(layers: &[(&str, f64)]) -> String {
    let mut keys = String::new();
    for (material, thickness_mm) in layers {
        let Some(Material { surface, density_kg_m3, specific_heat_j_kgk }) = find(material) else {
            continue;
        };
        keys += "[[object.layer]]\n";
        // Writing to a String cannot fail.
        if thickness_mm.is_finite() {
            let _ = writeln!(keys, "thickness_m = {:?}", thickness_mm * 1e-3);
        }
        let _ = writeln!(
            keys,
            "k_w_mk = {:?}\nrho_kg_m3 = {density_kg_m3:?}\nc_j_kgk = {specific_heat_j_kgk:?}",
            surface.conductivity_w_mk
        );
    }
    keys
}

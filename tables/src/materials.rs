//! The materials of the contact model.

use contact_model::material::{DESCRIPTIONS, MATERIALS};

use crate::part::Part;

/// Their names wherever a reader or a program needs all of them, and their properties.
pub fn parts() -> Vec<Part> {
    let names = MATERIALS.map(|(name, _)| name);
    let part = |file, name, text| Part { file, name, text };
    let lines = |line: fn(&str) -> String| names.map(line).concat();
    vec![
        part("docs/protocol.md", "materials", names.join(", ")),
        part("docs/scenes.md", "materials", names.join(", ")),
        part("docs/sessions.md", "materials", names.join(", ")),
        part("docs/objects.md", "materials", properties()),
        part(
            "python/src/thermal_display/words.py",
            "materials",
            lines(|name| format!("\"{name}\",\n")),
        ),
        part("tests/fuzz/scene.dict", "materials", lines(|name| format!("\"{name}\"\n"))),
        part(
            "tests/fuzz/wire.dict",
            "materials",
            lines(|name| format!("\"material {name}\\x0a\"\n")),
        ),
    ]
}

/// What a layer of a scene needs of each.
fn properties() -> String {
    let rows = MATERIALS.iter().zip(DESCRIPTIONS).map(|((name, material), description)| {
        let k_w_mk = material.surface.conductivity_w_mk;
        let (rho_kg_m3, c_j_kgk) = (material.density_kg_m3, material.specific_heat_j_kgk);
        format!("| {name} | {description} | {k_w_mk} | {rho_kg_m3} | {c_j_kgk} |\n")
    });
    let head = "\n| material | what it is; source | `k_w_mk` | `rho_kg_m3` | `c_j_kgk` |\n|---|---|---|---|---|\n";
    head.to_owned() + &rows.collect::<String>()
}

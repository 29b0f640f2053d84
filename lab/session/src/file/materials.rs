//! Materials that a session describes, and names of materials.

use contact_model::material::{self, MATERIALS, Material, Surface};

use super::source::SessionError;
use super::value::{LEVEL, Number, Value};
use thermal_wire::request::second_words;

/// Ranges of a material's properties: those of the device's line `material custom`.
pub(super) const PROPERTIES: [Number; 5] = [
    Number::new("k_w_mk", 0.001, 5000.0, None),
    Number::new("rho_kg_m3", 1.0, 30_000.0, None),
    Number::new("c_j_kgk", 10.0, 10_000.0, None),
    Number::new("rq_um", 0.001, 1000.0, None),
    Number::new("slope_rad", 0.0001, 1.5, None),
];

/// The materials of `[materials.NAME]`.
pub(super) fn materials(file: Option<&Value<'_>>) -> Result<Vec<(String, Material)>, SessionError> {
    let Some(file) = file else {
        return Ok(Vec::new());
    };
    let tables = file.any_table("a table for each material")?;
    let read = tables.values.iter().map(|(name, value)| {
        if material::find(name).is_some() || second_words("material").any(|word| word == *name) {
            return Err(value.error(format!(
                "materials.{name}: allowed is a name of its own; {} have their meaning",
                known(&[])
            )));
        }
        // A name is a level of a factor, and a word of the recorded tables.
        if !super::value::is_level(name) {
            return Err(value.error(format!("materials.{name}: allowed as a name is {LEVEL}")));
        }
        Ok(((*name).into(), properties(value)?))
    });
    read.collect()
}

fn properties(value: &Value<'_>) -> Result<Material, SessionError> {
    let table = value.table(&PROPERTIES.each_ref().map(|property| property.key))?;
    let [k, rho, c, rq, slope] = &PROPERTIES;
    Ok(Material {
        surface: Surface {
            conductivity_w_mk: table.number(k)?,
            roughness_um: table.number(rq)?,
            slope_rad: table.number(slope)?,
        },
        density_kg_m3: table.number(rho)?,
        specific_heat_j_kgk: table.number(c)?,
    })
}

/// Names of all materials, as errors list them.
pub(super) fn known(described: &[(String, Material)]) -> String {
    let described = described.iter().map(|(name, _)| &**name);
    let named = MATERIALS.iter().map(|(name, _)| *name);
    named.chain(described).collect::<Vec<_>>().join(", ")
}

/// Whether a material has this name.
pub(super) fn is_known(described: &[(String, Material)], name: &str) -> bool {
    described.iter().any(|(known, _)| known == name) || material::find(name).is_some()
}

//! The object of a scene.

use std::ops::Range;

use contact_model::material::{MATERIALS, Material, Surface, find};
use thermal_plant::object::ObjectConfig;
use thermal_plant::slab::{BackBoundary, Layer, Medium};
use thermal_protocol::check_line;
use toml::Spanned;

use super::file::{self, Number};
use super::source::{SceneError, Source};
use super::{Object, known_materials};

/// Largest thickness, m.
const THICKEST_M: f64 = 10.0;
/// Ranges of a layer's conductivity, W/(m K), density, kg/m3, and specific heat, J/(kg K): those that the device accepts
/// of a material.
const LAYER_RANGES: [(f64, f64); 3] = [(1e-3, 5e3), (1.0, 30e3), (10.0, 10e3)];

impl Object {
    /// The line by which a device is told of it, if it is one slab of its material that the device takes.
    pub fn slab_line(&self) -> Option<String> {
        let [Layer { thickness_m, .. }] = self.layers[..] else {
            return None;
        };
        if self.layers != [ObjectConfig::layer(&self.material, thickness_m)] {
            return None;
        }
        let back = match self.back {
            BackBoundary::Insulated => "insulated".into(),
            BackBoundary::Film { film_w_m2k, .. } if film_w_m2k.is_infinite() => "held".into(),
            BackBoundary::Film { film_w_m2k, .. } => format!("film {film_w_m2k}"),
        };
        let line = format!("object slab {}mm {back}", in_mm(thickness_m));
        check_line(&line).is_ok().then_some(line)
    }

    /// Its layers, from the touched face down, and its back, on one line: by the name of a material, or by conductivity and
    /// heat capacity per volume.
    pub fn description(&self) -> String {
        let layer = |layer: &Layer| {
            let medium = &layer.medium;
            let named = (MATERIALS.iter())
                .find(|(_, material)| ObjectConfig::layer(material, 0.0).medium == *medium);
            let of = named.map_or_else(
                || {
                    let (k, capacity) = (medium.conductivity_w_mk, medium.capacity_j_m3k);
                    format!("k={k} W/(m K) rho*c={capacity:.3e} J/(m3 K)")
                },
                |(name, _)| (*name).into(),
            );
            if layer.thickness_m.is_infinite() {
                format!("{of}, endless")
            } else {
                format!("{of}, {} mm", in_mm(layer.thickness_m))
            }
        };
        let layers: Vec<_> = self.layers.iter().map(layer).collect();
        let back = match self.back {
            _ if self.layers.last().is_some_and(|last| last.thickness_m.is_infinite()) => {
                String::new()
            }
            BackBoundary::Insulated => "; back insulated".into(),
            BackBoundary::Film { film_w_m2k, temperature_c } if film_w_m2k.is_infinite() => {
                format!("; back held at {temperature_c} C")
            }
            BackBoundary::Film { film_w_m2k, temperature_c } => {
                format!("; back film of {film_w_m2k} W/(m2 K) to {temperature_c} C")
            }
        };
        layers.join(" | ") + &back
    }
}

/// A thickness in mm, to a nanometre.
fn in_mm(thickness_m: f64) -> f64 {
    (1e9 * thickness_m).round() / 1e6
}

/// Reads and checks the table `[object]`.
pub(super) fn object(
    source: &Source<'_>,
    file: &Spanned<file::Object>,
    duration_s: f64,
    room_c: f64,
) -> Result<Object, SceneError> {
    let (object, span) = (file.get_ref(), &file.span());
    let properties = [
        ("k_w_mk", &object.k_w_mk),
        ("rho_kg_m3", &object.rho_kg_m3),
        ("c_j_kgk", &object.c_j_kgk),
        ("rq_um", &object.rq_um),
        ("slope_rad", &object.slope_rad),
    ];
    let (name, material) = if let Some(name) = &object.material {
        if let Some((key, number)) =
            properties.iter().find_map(|(key, number)| Some((key, number.as_ref()?)))
        {
            let problem = format!(
                "object.{key} beside object.material; allowed is either a name or properties"
            );
            return Err(source.error(Some(number.span()), problem));
        }
        let Some(material) = find(name.get_ref()) else {
            let problem =
                format!("object.material = {:?}; known are {}", name.get_ref(), known_materials());
            return Err(source.error(Some(name.span()), problem));
        };
        (name.get_ref().clone(), *material)
    } else {
        ("custom".into(), custom(source, properties, span)?)
    };
    let start_c = object
        .start_c
        .as_ref()
        .map(|start_c| source.within("object.start_c", start_c, -20.0, 60.0))
        .transpose()?;
    let appears_t_s =
        source.within_or(0.0, "object.appears_t_s", &object.appears_t_s, 0.0, duration_s)?;
    let layers = layers(source, object, &material)?;
    let back = back(source, object, (&layers, room_c, start_c.unwrap_or(room_c)))?;
    Ok(Object { name, material, start_c, appears_t_s, layers, back })
}

/// The layers of the scene, or one layer of the object's material if the scene has none.
fn layers(
    source: &Source<'_>,
    object: &file::Object,
    material: &Material,
) -> Result<Vec<Layer>, SceneError> {
    let thickness_m = |key: &str, number: &Option<Number>| {
        let (least, most) = (ObjectConfig::THINNEST_M, THICKEST_M);
        source.within_or(f64::INFINITY, key, number, least, most)
    };
    let Some(last) = object.layer.len().checked_sub(1) else {
        let thickness_m = thickness_m("object.thickness_m", &object.thickness_m)?;
        return Ok(vec![ObjectConfig::layer(material, thickness_m)]);
    };
    if let Some(number) = &object.thickness_m {
        let problem =
            "object.thickness_m beside object.layer; allowed is either one thickness or layers";
        return Err(source.error(Some(number.span()), problem));
    }
    let layer = |(i, layer): (usize, &Spanned<file::ObjectLayer>)| {
        let key = |field: &str| format!("object.layer.{i}.{field}");
        let (file, [k, rho, c]) = (layer.get_ref(), &LAYER_RANGES);
        if file.thickness_m.is_none() && i < last {
            let problem =
                format!("{} is missing; only the last layer may be endless", key("thickness_m"));
            return Err(source.error(Some(layer.span()), problem));
        }
        let number =
            |field: &str, number, (least, most)| source.within(&key(field), number, least, most);
        Ok(Layer {
            thickness_m: thickness_m(&key("thickness_m"), &file.thickness_m)?,
            medium: Medium {
                conductivity_w_mk: number("k_w_mk", &file.k_w_mk, *k)?,
                capacity_j_m3k: number("rho_kg_m3", &file.rho_kg_m3, *rho)?
                    * number("c_j_kgk", &file.c_j_kgk, *c)?,
                perfusion_w_m3k: 0.0,
                metabolism_w_m3: 0.0,
            },
        })
    };
    object.layer.iter().enumerate().map(layer).collect()
}

/// Boundary condition behind the last layer. For an infinitely thick layer the scene must give none.
fn back(
    source: &Source<'_>,
    object: &file::Object,
    (layers, room_c, start_c): (&[Layer], f64, f64),
) -> Result<BackBoundary, SceneError> {
    let meaningless = |key: &str, span, needed: &str| {
        let problem = format!("object.{key} has no meaning here; allowed is {key} beside {needed}");
        Err(source.error(Some(span), problem))
    };
    let endless = layers.last().is_some_and(|last| last.thickness_m.is_infinite());
    if let (true, Some(back)) = (endless, &object.back) {
        let needed = if object.layer.is_empty() {
            "object.thickness_m"
        } else {
            "thickness_m of the last object.layer"
        };
        return meaningless("back", back.span(), needed);
    }
    let kind = object.back.as_ref().map_or(file::Back::Insulated, |back| *back.get_ref());
    if let (file::Back::Insulated, Some(number)) = (kind, &object.back_c) {
        return meaningless("back_c", number.span(), "back = \"held\" or \"film\"");
    }
    let back_c =
        |default_c| source.within_or(default_c, "object.back_c", &object.back_c, -20.0, 60.0);
    let film = match (kind, &object.back_film_w_m2k) {
        (file::Back::Film, Some(number)) => {
            Some(source.within("object.back_film_w_m2k", number, 0.1, 1e6)?)
        }
        (file::Back::Film, None) => {
            let span = object.back.as_ref().map(Spanned::span);
            let problem =
                "object.back = \"film\" without object.back_film_w_m2k; allowed is 0.1 to 1000000";
            return Err(source.error(span, problem));
        }
        (_, Some(number)) => {
            return meaningless("back_film_w_m2k", number.span(), "back = \"film\"");
        }
        (_, None) => None,
    };
    Ok(match (kind, film) {
        (file::Back::Insulated, _) => BackBoundary::Insulated,
        (_, Some(film_w_m2k)) => BackBoundary::Film { film_w_m2k, temperature_c: back_c(room_c)? },
        (_, None) => {
            BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: back_c(start_c)? }
        }
    })
}

/// A material given by its properties; they must be within the ranges that the device accepts.
fn custom(
    source: &Source<'_>,
    properties: [(&str, &Option<Number>); 5],
    span: &Range<usize>,
) -> Result<Material, SceneError> {
    let mut values = [0.0; 5];
    for (value, (key, number)) in values.iter_mut().zip(properties) {
        let Some(number) = number else {
            let problem = format!(
                "object.{key} is missing; an object has a material or all of its properties"
            );
            return Err(source.error(Some(span.clone()), problem));
        };
        *value = *number.get_ref();
    }
    let [conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad] = values;
    let surface = Surface { conductivity_w_mk, roughness_um, slope_rad };
    let material = Material { surface, density_kg_m3, specific_heat_j_kgk };
    match check_line(&custom_line(&material)) {
        Ok(()) => Ok(material),
        Err(refused) => {
            let problem = format!("object: the device would answer {:?}", refused.to_string());
            Err(source.error(Some(span.clone()), problem))
        }
    }
}

/// The line that sends a material's properties to the device.
pub(crate) fn custom_line(material: &Material) -> String {
    let Surface { conductivity_w_mk, roughness_um, slope_rad } = material.surface;
    let (density, heat) = (material.density_kg_m3, material.specific_heat_j_kgk);
    // Nine decimals are more than the device keeps, and five such numbers fit its line.
    let numbers = [conductivity_w_mk, density, heat, roughness_um, slope_rad]
        .map(|number| format!("{number:.9}"));
    let short = numbers.each_ref().map(|number| number.trim_end_matches('0').trim_end_matches('.'));
    format!("material custom {}", short.join(" "))
}

//! The plant parameters of a scene: its finger, a random draw, and single values.

use std::ops::Range;

use contact_model::material::SKIN;
use thermal_plant::finger::{BLOOD_J_M3K, FingerParams, Vessels};
use thermal_plant::slab::{Layer, Medium};
use thermal_plant::{Params, parameters};
use toml::Spanned;

use super::file::{self, ParameterNode};
use super::source::{SceneError, Source};

/// The parameters: nominal or drawn, then overridden by the values of the scene.
pub(super) fn params(
    source: &Source<'_>,
    finger: Option<&Spanned<file::Finger>>,
    plant: Option<&Spanned<ParameterNode>>,
) -> Result<Params, SceneError> {
    let mut params = Params::nominal();
    if let Some(finger) = finger {
        tissue(source, finger.get_ref(), &mut params)?;
        finger_values(source, finger.get_ref(), &mut params)?;
    }
    let Some(plant) = plant else {
        return Ok(params);
    };
    let ParameterNode::Table(entries) = plant.get_ref() else {
        return Err(source.error(
            Some(plant.span()),
            "plant is a number; allowed is a table of parameters",
        ));
    };
    let (draws, values): (Vec<_>, Vec<_>) =
        entries.iter().partition(|(key, _)| key.get_ref() == "draw");
    for (_, seed) in draws {
        parameters::draw(&mut params, seed_of(source, seed)?);
        if let Some(finger) = finger {
            finger_values(source, finger.get_ref(), &mut params)?;
        }
    }
    for (key, node) in values {
        set(source, &mut params, key.get_ref().clone(), node)?;
    }
    Ok(params)
}

fn seed_of(source: &Source<'_>, seed: &Spanned<ParameterNode>) -> Result<u64, SceneError> {
    match seed.get_ref() {
        ParameterNode::Whole(seed) if *seed >= 0 => Ok(seed.unsigned_abs()),
        _ => {
            let problem = format!(
                "plant.draw is the seed of a draw; allowed is a whole number, 0 to {}",
                i64::MAX
            );
            Err(source.error(Some(seed.span()), problem))
        }
    }
}

/// Sets the parameters below a key.
fn set(
    source: &Source<'_>,
    params: &mut Params,
    key: String,
    node: &Spanned<ParameterNode>,
) -> Result<(), SceneError> {
    match node.get_ref() {
        ParameterNode::Number(value) => source.set(params, &key, *value, node.span()),
        ParameterNode::Whole(value) => source.set(params, &key, *value as f64, node.span()),
        ParameterNode::Table(entries) => entries.iter().try_for_each(|(name, node)| {
            set(source, params, format!("{key}.{}", name.get_ref()), node)
        }),
    }
}

/// The kind of tissue of the finger, and whether its vessels are modelled.
fn tissue(
    source: &Source<'_>,
    finger: &file::Finger,
    params: &mut Params,
) -> Result<(), SceneError> {
    if let (Some(tissue), false) = (&finger.tissue, finger.layer.is_empty()) {
        let problem =
            "finger.tissue beside finger.layer; allowed is either nominal tissue or layers";
        return Err(source.error(Some(tissue.span()), problem));
    }
    params.finger = match finger.tissue.as_ref().map(Spanned::get_ref) {
        Some(file::Tissue::Layered) => FingerParams::layered(),
        Some(file::Tissue::Homogeneous) | None => FingerParams::homogeneous(),
    };
    match finger.vessels {
        Some(true) => params.finger.vessels = Some(Vessels::THESIS),
        Some(false) => params.finger.vessels = None,
        None => {}
    }
    Ok(())
}

/// Sets the finger's values that the scene gives.
fn finger_values(
    source: &Source<'_>,
    finger: &file::Finger,
    params: &mut Params,
) -> Result<(), SceneError> {
    if !finger.layer.is_empty() {
        let unset = Layer {
            thickness_m: f64::INFINITY,
            medium: Medium::without_blood(&SKIN),
        };
        params.finger.layers = vec![unset; finger.layer.len()];
        for (i, layer) in finger.layer.iter().enumerate() {
            let last = i + 1 == finger.layer.len();
            layer_values(source, params, &format!("finger.layer.{i}"), layer, last)?;
        }
    }
    if let Some(core_w_m2k) = &finger.core_w_m2k {
        params.finger.core_w_m2k = Some(0.0);
        number(source, params, "finger.core_w_m2k", core_w_m2k)?;
    }
    if let Some(air_w_m2k) = &finger.air_w_m2k {
        number(source, params, "finger.air_w_m2k", air_w_m2k)?;
    }
    Ok(())
}

fn number(
    source: &Source<'_>,
    params: &mut Params,
    key: &str,
    number: &file::Number,
) -> Result<(), SceneError> {
    source.set(params, key, *number.get_ref(), number.span())
}

fn layer_values(
    source: &Source<'_>,
    params: &mut Params,
    key: &str,
    layer: &Spanned<file::Layer>,
    last: bool,
) -> Result<(), SceneError> {
    let file::Layer {
        thickness_m,
        k_w_mk,
        rho_kg_m3,
        c_j_kgk,
        perfusion_1_s,
        metabolism_w_m3,
    } = layer.get_ref();
    let mut set = |field: &str, value: f64, span: Range<usize>| {
        source.set(params, &format!("{key}.{field}"), value, span)
    };
    match thickness_m {
        Some(thickness) => set("thickness_m", *thickness.get_ref(), thickness.span())?,
        None if last => {}
        None => {
            let problem =
                format!("{key}.thickness_m is missing; only the last layer may be endless");
            return Err(source.error(Some(layer.span()), problem));
        }
    }
    set("conductivity_w_mk", *k_w_mk.get_ref(), k_w_mk.span())?;
    let rho = source.within("finger.layer.rho_kg_m3", rho_kg_m3, 1.0, 30e3)?;
    let c = source.within("finger.layer.c_j_kgk", c_j_kgk, 50.0, 20e3)?;
    set("capacity_j_m3k", rho * c, c_j_kgk.span())?;
    if let Some(perfusion) = perfusion_1_s {
        let perfusion_w_m3k = perfusion.get_ref() * BLOOD_J_M3K;
        set("perfusion_w_m3k", perfusion_w_m3k, perfusion.span())?;
    }
    if let Some(metabolism) = metabolism_w_m3 {
        set("metabolism_w_m3", *metabolism.get_ref(), metabolism.span())?;
    }
    Ok(())
}

//! The plant parameters of a scene: its finger, random draws, and single values.

use std::ops::Range;

use contact_model::material::SKIN;
use thermal_plant::Params;
use thermal_plant::finger::{BLOOD_J_M3K, FingerParams, Vessels};
use thermal_plant::parameters::{self, FingerDraw};
use thermal_plant::sensors::FluxParams;
use thermal_plant::slab::{Layer, Medium};
use toml::Spanned;

use super::Draws;
use super::file::{self, NodeNumber, ParameterNode};
use super::source::{SceneError, Source};

/// The nominal parameters, with the scene's finger and its heat-flux sensor; the same drawn, then overridden by the values of the
/// scene; and what was drawn.
pub(super) fn params(
    source: &Source<'_>,
    finger: Option<&Spanned<file::Finger>>,
    plant: Option<&Spanned<ParameterNode>>,
    flux_sensor: bool,
) -> Result<(Params, Params, Draws), SceneError> {
    let (mut params, mut draws) = (Params::nominal(), Draws::default());
    params.flux = flux_sensor.then_some(FluxParams::NOMINAL);
    if let Some(finger) = finger {
        tissue(source, finger.get_ref(), &mut params)?;
        finger_values(source, finger.get_ref(), &mut params)?;
    }
    let nominal = params.clone();
    let values = values(source, plant)?;
    let seed = |wanted: &str| {
        let value = values.iter().find(|(key, ..)| key == wanted);
        let value = value.map(|(key, seed, span)| (format!("plant.{key}"), *seed, span.clone()));
        value.map(|value| seed_of(source, &value)).transpose()
    };
    draws.plant = seed(DRAW)?;
    draws.contact = seed(CONTACT_DRAW)?;
    if let Some(seed) = draws.plant {
        parameters::draw(&mut params, seed);
        if let Some(finger) = finger {
            finger_values(source, finger.get_ref(), &mut params)?;
        }
    }
    if let Some(seed) = draws.contact {
        parameters::draw_contact(&mut params, seed);
    }
    if let Some(finger) = finger {
        draws.finger = drawn_finger(source, finger.get_ref(), nominal.finger.clone(), &mut params)?;
    }
    for (key, value, span) in values {
        if key != DRAW && key != CONTACT_DRAW {
            source.set(&mut params, &key, value.real(), span)?;
        }
    }
    Ok((nominal, params, draws))
}

/// Draws the finger around what the scene gives of it, and keeps the surface, which is drawn with the plant.
fn drawn_finger(
    source: &Source<'_>,
    finger: &file::Finger,
    undrawn: FingerParams,
    params: &mut Params,
) -> Result<Option<FingerDraw>, SceneError> {
    let Some(seed) = &finger.draw else {
        return Ok(None);
    };
    let seed = seed_of(source, &("finger.draw".into(), *seed.get_ref(), seed.span()))?;
    params.finger = FingerParams { surface: params.finger.surface, ..undrawn };
    let layered =
        matches!(finger.tissue.as_ref().map(Spanned::get_ref), Some(file::Tissue::Layered));
    let draw = parameters::draw_finger(&mut params.finger, seed, layered);
    vessels(finger, params);
    films(source, finger, params)?;
    Ok(Some(draw))
}

/// The numbers below `plant`.
fn values(
    source: &Source<'_>,
    plant: Option<&Spanned<ParameterNode>>,
) -> Result<Vec<Value>, SceneError> {
    let mut values = Vec::new();
    let Some(plant) = plant else {
        return Ok(values);
    };
    let ParameterNode::Table(entries) = plant.get_ref() else {
        return Err(
            source.error(Some(plant.span()), "plant is a number; allowed is a table of parameters")
        );
    };
    for (key, node) in entries {
        collect(key.get_ref().clone(), node, &mut values);
    }
    Ok(values)
}

/// Keys of the seeds.
const DRAW: &str = "draw";
const CONTACT_DRAW: &str = "contact.draw";

/// A number: its key, value, and position.
type Value = (String, NodeNumber, Range<usize>);

fn seed_of(source: &Source<'_>, (key, seed, span): &Value) -> Result<u64, SceneError> {
    match seed {
        NodeNumber::Whole(seed) if *seed >= 0 => Ok(seed.unsigned_abs()),
        _ => {
            let value = seed.real();
            let problem = format!(
                "{key} = {value} is the seed of a draw; allowed is a whole number, 0 to {}",
                i64::MAX
            );
            Err(source.error(Some(span.clone()), problem))
        }
    }
}

/// Collects the numbers at and below a key.
fn collect(key: String, node: &Spanned<ParameterNode>, values: &mut Vec<Value>) {
    match node.get_ref() {
        ParameterNode::Number(value) => values.push((key, *value, node.span())),
        ParameterNode::Table(entries) => {
            for (name, node) in entries {
                collect(format!("{key}.{}", name.get_ref()), node, values);
            }
        }
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
    vessels(finger, params);
    Ok(())
}

fn vessels(finger: &file::Finger, params: &mut Params) {
    match finger.vessels {
        Some(true) => params.finger.vessels = Some(Vessels::THESIS),
        Some(false) => params.finger.vessels = None,
        None => {}
    }
}

/// Sets the finger's values that the scene gives.
fn finger_values(
    source: &Source<'_>,
    finger: &file::Finger,
    params: &mut Params,
) -> Result<(), SceneError> {
    if !finger.layer.is_empty() {
        let unset = Layer { thickness_m: f64::INFINITY, medium: Medium::without_blood(&SKIN) };
        params.finger.layers = vec![unset; finger.layer.len()];
        for (i, layer) in finger.layer.iter().enumerate() {
            let last = i + 1 == finger.layer.len();
            layer_values(source, params, &format!("finger.layer.{i}"), layer, last)?;
        }
    }
    films(source, finger, params)
}

/// Sets core and air film as far as the scene gives them.
fn films(
    source: &Source<'_>,
    finger: &file::Finger,
    params: &mut Params,
) -> Result<(), SceneError> {
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
    let file::Layer { thickness_m, k_w_mk, rho_kg_m3, c_j_kgk, perfusion_1_s, metabolism_w_m3 } =
        layer.get_ref();
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

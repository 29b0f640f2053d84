//! Reads and checks the text of a scene.

use std::ops::Range;
use std::path::Path;

use thermal_client::text::control_in_toml;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_device::safety::Setpoint;
use thermal_plant::parameters::PlaceBeforeContact;
use thermal_plant::{ConfigError, Params, Plant};
use toml::Spanned;
use toml::de::DeTable;

use super::fault::faults;
use super::file::{self, File};
use super::infrared::infrared;
use super::nesting;
use super::object::object;
use super::plant::params;
use super::source::{SceneError, Source};
use super::{AssumedFinger, Draws, Force, HostLine, Scene};
use crate::processor::ChipState;
use thermal_device::Vocabulary as _;

/// Settling time of a scene that gives none, and the shortest: the slowest preset is reached to a few mK, s.
const SETTLE_S: f64 = 8.0;

pub(super) fn scene(text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Source { file: path, text };
    nesting::check(&source)?;
    // A text that is no TOML is reported below.
    if let Ok(document) = DeTable::parse(text)
        && let Some((at, problem)) = control_in_toml(document.get_ref())
    {
        return Err(source.error(Some(at..at), problem));
    }
    let file: File = toml::from_str(text).map_err(|error| {
        // The reader names types of its own.
        let problem = (error.message().replace("expected f64", "expected a number"))
            .replace("expected u64", "expected a whole number from 0")
            .replace("expected u32", "expected a whole number from 0")
            .replace(
                "map, expected a sequence",
                "a table in single brackets, expected double ones",
            );
        let wrong = source.wrong_value(error.span(), &problem);
        source.error(error.span(), wrong.unwrap_or(problem))
    })?;
    let duration_s = source.within("duration_s", &file.duration_s, 0.001, 86_400.0)?;
    let settle_s = source.within_or(SETTLE_S, "settle_s", &file.settle_s, SETTLE_S, 3600.0)?;
    let (skin_c, room_c) = (
        source.within("skin_c", &file.skin_c, 15.0, 42.0)?,
        source.within("room_c", &file.room_c, 5.0, 40.0)?,
    );
    let mode = match file.mode {
        file::Mode::Contact => ContactModel::ContactResistance,
        file::Mode::SemiInfinite => ContactModel::SemiInfinite,
    };
    let (faults, injections) =
        faults(&source, &file.fault, file.device.flux_sensor, duration_s, file.seed)?;
    let (nominal, params, draws) =
        params(&source, file.finger.as_ref(), file.plant.as_ref(), file.device.flux_sensor)?;
    let assumed_finger = assumed_finger(&file, &params, &draws);
    let scene = Scene {
        duration_s,
        settle_s,
        skin_c,
        room_c,
        seed: file.seed,
        commissioned: file.device.commissioned,
        measured_surface: file.device.measured_surface,
        enrolled: enrolled(&source, &file.device, assumed_finger)?,
        chip: chip(&source, &file.device)?,
        mode,
        law: file.law.as_ref().map(|name| law(&source, name)).transpose()?,
        object: object(&source, &file.object, duration_s, room_c)?,
        assumed_finger,
        object_as_half_space: file.object.get_ref().told.is_some(),
        nominal,
        params,
        draws,
        infrared: match &file.infrared {
            Some(file) => Some(infrared(&source, file, room_c)?),
            None => None,
        },
        forces: forces(&source, &file.force, duration_s)?,
        faults,
        injections,
        triggers_s: (file.trigger.iter())
            .map(|trigger| source.time("trigger.t_s", &trigger.t_s, duration_s))
            .collect::<Result<_, _>>()?,
        host: (file.host.iter())
            .map(|host| {
                let t_s = source.time("host.t_s", &host.t_s, duration_s)?;
                Ok(HostLine { t_s, line: host.line.get_ref().clone() })
            })
            .collect::<Result<_, _>>()?,
        course: None,
    };
    let object_at = match &file.object.get_ref().start_c {
        Some(start_c) => start_c.span(),
        None => file.object.span(),
    };
    setpoint(&source, &scene, object_at)?;
    // Building the plant shows parameters that contradict each other.
    Plant::new(&scene.plant_config()).map_err(|error| {
        let finger = file.finger.as_ref().map(|finger| finger.span());
        let plant = file.plant.as_ref().map(|plant| plant.span());
        let span = match error {
            ConfigError::ColdFinger { .. } => finger.or(plant),
            _ => plant.or(finger),
        };
        // The nominal plant can contradict the temperatures only.
        source.error(span.or(Some(file.skin_c.span())), error.to_string())
    })?;
    Ok(scene)
}

/// The finger that the operator lets the device assume; what the scene leaves open follows from what the operator sees: a
/// finger of layers or the thesis's, in air or on a pad before its contact.
fn assumed_finger(file: &File, params: &Params, draws: &Draws) -> AssumedFinger {
    let drawn = draws.finger.and_then(|finger| finger.tissue);
    let given = file.finger.as_ref().is_some_and(|finger| finger.get_ref().air_w_m2k.is_some());
    match file.device.finger {
        Some(file::AssumedFinger::Thesis) => AssumedFinger::Thesis,
        Some(file::AssumedFinger::Mean) => AssumedFinger::Mean,
        Some(file::AssumedFinger::MeanOnPad) => AssumedFinger::MeanOnPad,
        None if params.finger.is_half_space() => AssumedFinger::Thesis,
        None if !given && drawn.is_some_and(|tissue| tissue.before == PlaceBeforeContact::Pad) => {
            AssumedFinger::MeanOnPad
        }
        None => AssumedFinger::Mean,
    }
}

/// Whether the finger was enrolled, which needs a heat-flux sensor, and another finger than the thesis's.
fn enrolled(
    source: &Source<'_>,
    device: &file::Device,
    assumed: AssumedFinger,
) -> Result<bool, SceneError> {
    let enrolled = *device.enrolled.get_ref();
    if enrolled && !device.flux_sensor {
        let problem = "device.enrolled = true without device.flux_sensor = true; a finger is learnt by the sensor only";
        return Err(source.error(Some(device.enrolled.span()), problem));
    }
    if enrolled && !assumed.is_layered() {
        let problem = "device.enrolled = true with the thesis's finger, of which nothing is learnt; allowed is finger.tissue = \"layered\", or device.finger = \"mean\" or \"mean-on-pad\"";
        return Err(source.error(Some(device.enrolled.span()), problem));
    }
    Ok(enrolled)
}

/// The microcontroller before its program starts.
fn chip(source: &Source<'_>, device: &file::Device) -> Result<ChipState, SceneError> {
    let whole = |key, value: &Option<Spanned<u32>>, nominal: u32, (least, most): (u32, u32)| {
        let Some(value) = value else {
            return Ok(nominal);
        };
        let given = *value.get_ref();
        if (least..=most).contains(&given) {
            return Ok(given);
        }
        let problem = format!("device.{key} = {given}; allowed is {least} to {most}");
        Err(source.error(Some(value.span()), problem))
    };
    let nominal = ChipState::default();
    let lsi_hz = (*ChipState::LSI_HZ.start(), *ChipState::LSI_HZ.end());
    let start_us = ChipState::EXTERNAL_CLOCK_START_US;
    let level = whole("brown_out_level", &device.brown_out_level, 3, (0, 3))?;
    Ok(ChipState {
        // 00 is level 3, 11 is off.
        brown_out_code: 3 - level as u8,
        lsi_hz: whole("lsi_hz", &device.lsi_hz, nominal.lsi_hz, lsi_hz)?,
        external_clock: device.external_clock,
        external_clock_start_us: whole(
            "external_clock_start_us",
            &device.external_clock_start_us,
            nominal.external_clock_start_us,
            (*start_us.start(), *start_us.end()),
        )?,
        slow_flash: device.slow_flash,
        flash: device.flash,
        strict: device.strict,
        ..nominal
    })
}

/// The control law of a name, with the names of the device's protocol.
fn law(source: &Source<'_>, name: &Spanned<String>) -> Result<Law, SceneError> {
    Law::of_word(name.get_ref()).ok_or_else(|| {
        let words = Law::WORDS.words.join(", ");
        let problem = format!("law = {:?}; known are {words}", name.get_ref());
        source.error(Some(name.span()), problem)
    })
}

fn forces(
    source: &Source<'_>,
    rows: &[file::Force],
    duration_s: f64,
) -> Result<Vec<Force>, SceneError> {
    let mut forces: Vec<Force> = Vec::with_capacity(rows.len());
    for row in rows {
        let force = Force {
            t_s: source.time("force.t_s", &row.t_s, duration_s)?,
            force_n: source.within("force.force_n", &row.force_n, 0.0, 10.0)?,
            ramp_s: source.within_or(0.0, "force.ramp_s", &row.ramp_s, 0.0, duration_s)?,
        };
        if let Some(before) = forces.last() {
            let free_s = before.t_s + before.ramp_s;
            if force.t_s <= before.t_s || force.t_s < free_s {
                let problem = format!(
                    "force.t_s = {}; allowed is after {free_s}, when the force before is reached",
                    force.t_s
                );
                return Err(source.error(Some(row.t_s.span()), problem));
            }
        }
        forces.push(force);
    }
    Ok(forces)
}

/// The first set-point must be within the range of the display.
fn setpoint(source: &Source<'_>, scene: &Scene, span: Range<usize>) -> Result<(), SceneError> {
    let preset_c = scene.exact_setpoint_c(0.0, 1.0);
    let [least, most] = [Setpoint::MIN, Setpoint::MAX].map(|limit| limit.celsius().to_num::<f64>());
    if (least..=most).contains(&preset_c) {
        return Ok(());
    }
    let problem = format!(
        "an object of {} C would set the display to {preset_c:.2} C; allowed is {least} to {most} C",
        scene.object_c()
    );
    Err(source.error(Some(span), problem))
}

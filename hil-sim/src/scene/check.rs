//! From the text of a scene to a scene, or to what is wrong with it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use contact_model::material::{Material, Surface, find};
use thermal_display::guard::Setpoint;
use thermal_display::protocol::Command;
use thermal_display::render::Mode;
use thermal_display::settings::Settings;

use super::file::{self, File, Number};
use super::{Fault, Force, HostLine, Object, Scene, known_materials};

/// Settling time of a scene that gives none, and the shortest: the slowest preset is reached to a few mK, s.
const SETTLE_S: f64 = 8.0;

/// What is wrong with a scene, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    file: PathBuf,
    line: Option<usize>,
    problem: String,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.problem)
    }
}

impl std::error::Error for SceneError {}

impl SceneError {
    pub(super) fn unreadable(file: &Path, error: &std::io::Error) -> Self {
        Self {
            file: file.into(),
            line: None,
            problem: format!("cannot be read: {error}"),
        }
    }
}

/// Where messages point.
struct Source<'a> {
    file: &'a Path,
    text: &'a str,
}

impl Source<'_> {
    fn error(&self, span: Option<Range<usize>>, problem: impl Into<String>) -> SceneError {
        let line = span.map(|span| {
            let before = self.text.as_bytes().iter().take(span.start);
            before.filter(|byte| **byte == b'\n').count() + 1
        });
        SceneError {
            file: self.file.into(),
            line,
            problem: problem.into(),
        }
    }

    /// The number, if it lies within the range.
    fn within(&self, key: &str, number: &Number, least: f64, most: f64) -> Result<f64, SceneError> {
        let value = *number.get_ref();
        if (least..=most).contains(&value) {
            return Ok(value);
        }
        let problem = format!("{key} = {value}; allowed is {least} to {most}");
        Err(self.error(Some(number.span()), problem))
    }

    fn time(&self, key: &str, number: &Number, duration_s: f64) -> Result<f64, SceneError> {
        self.within(key, number, 0.0, duration_s)
    }
}

pub(super) fn scene(text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Source { file: path, text };
    let file: File = toml::from_str(text).map_err(|error| source.error(error.span(), error.message()))?;
    let duration_s = source.within("duration_s", &file.duration_s, 0.001, 86_400.0)?;
    let settle_s = match &file.settle_s {
        Some(number) => source.within("settle_s", number, SETTLE_S, 3600.0)?,
        None => SETTLE_S,
    };
    let (skin_c, room_c) = (
        source.within("skin_c", &file.skin_c, 15.0, 42.0)?,
        source.within("room_c", &file.room_c, 5.0, 40.0)?,
    );
    let mode = match file.mode {
        file::Mode::Contact => Mode::ContactResistance,
        file::Mode::SemiInfinite => Mode::SemiInfinite,
    };
    let scene = Scene {
        duration_s,
        settle_s,
        skin_c,
        room_c,
        seed: file.seed,
        mode,
        object: object(&source, file.object.get_ref(), &file.object.span(), duration_s)?,
        forces: forces(&source, &file.force, duration_s)?,
        faults: (file.fault.iter())
            .map(|fault| {
                let t_s = source.time("fault.t_s", &fault.t_s, duration_s)?;
                Ok(Fault {
                    kind: fault.kind,
                    t_s,
                })
            })
            .collect::<Result<_, _>>()?,
        host: (file.host.iter())
            .map(|host| {
                let t_s = source.time("host.t_s", &host.t_s, duration_s)?;
                Ok(HostLine {
                    t_s,
                    line: host.line.get_ref().clone(),
                })
            })
            .collect::<Result<_, _>>()?,
    };
    let object_at = match &file.object.get_ref().start_c {
        Some(start_c) => start_c.span(),
        None => file.object.span(),
    };
    setpoint(&source, &scene, object_at)?;
    Ok(scene)
}

fn object(
    source: &Source<'_>,
    object: &file::Object,
    span: &Range<usize>,
    duration_s: f64,
) -> Result<Object, SceneError> {
    let properties = [
        ("k_w_mk", &object.k_w_mk),
        ("rho_kg_m3", &object.rho_kg_m3),
        ("c_j_kgk", &object.c_j_kgk),
        ("rq_um", &object.rq_um),
        ("slope_rad", &object.slope_rad),
    ];
    let (name, material) = if let Some(name) = &object.material {
        if let Some((key, number)) = properties
            .iter()
            .find_map(|(key, number)| Some((key, number.as_ref()?)))
        {
            let problem =
                format!("object.{key} beside object.material; allowed is either a name or properties");
            return Err(source.error(Some(number.span()), problem));
        }
        let Some(material) = find(name.get_ref()) else {
            let problem = format!(
                "object.material = {:?}; known are {}",
                name.get_ref(),
                known_materials()
            );
            return Err(source.error(Some(name.span()), problem));
        };
        (name.get_ref().clone(), *material)
    } else {
        ("custom".into(), custom(source, properties, span)?)
    };
    let start_c = match &object.start_c {
        Some(number) => Some(source.within("object.start_c", number, -20.0, 60.0)?),
        None => None,
    };
    let appears_t_s = match &object.appears_t_s {
        Some(number) => source.time("object.appears_t_s", number, duration_s)?,
        None => 0.0,
    };
    Ok(Object {
        name,
        material,
        start_c,
        appears_t_s,
    })
}

/// A material given by its properties; the ranges are those that the device itself accepts.
fn custom(
    source: &Source<'_>,
    properties: [(&str, &Option<Number>); 5],
    span: &Range<usize>,
) -> Result<Material, SceneError> {
    let mut values = [0.0; 5];
    for (value, (key, number)) in values.iter_mut().zip(properties) {
        let Some(number) = number else {
            let problem =
                format!("object.{key} is missing; an object has a material or all of its properties");
            return Err(source.error(Some(span.clone()), problem));
        };
        *value = *number.get_ref();
    }
    let [
        conductivity_w_mk,
        density_kg_m3,
        specific_heat_j_kgk,
        roughness_um,
        slope_rad,
    ] = values;
    let surface = Surface {
        conductivity_w_mk,
        roughness_um,
        slope_rad,
    };
    let material = Material {
        surface,
        density_kg_m3,
        specific_heat_j_kgk,
    };
    match Command::parse(&custom_line(&material), &Settings::default()) {
        Ok(_) => Ok(material),
        Err(refused) => {
            let problem = format!("object: the device would answer {:?}", refused.to_string());
            Err(source.error(Some(span.clone()), problem))
        }
    }
}

/// The line that tells the device of a material by its properties.
pub(crate) fn custom_line(material: &Material) -> String {
    let Surface {
        conductivity_w_mk,
        roughness_um,
        slope_rad,
    } = material.surface;
    let (density, heat) = (material.density_kg_m3, material.specific_heat_j_kgk);
    // Nine decimals are more than the device keeps, and five such numbers fit its line.
    let numbers =
        [conductivity_w_mk, density, heat, roughness_um, slope_rad].map(|number| format!("{number:.9}"));
    let short = numbers
        .each_ref()
        .map(|number| number.trim_end_matches('0').trim_end_matches('.'));
    format!("material custom {}", short.join(" "))
}

fn forces(source: &Source<'_>, rows: &[file::Force], duration_s: f64) -> Result<Vec<Force>, SceneError> {
    let mut forces: Vec<Force> = Vec::with_capacity(rows.len());
    for row in rows {
        let force = Force {
            t_s: source.time("force.t_s", &row.t_s, duration_s)?,
            force_n: source.within("force.force_n", &row.force_n, 0.0, 10.0)?,
            ramp_s: match &row.ramp_s {
                Some(number) => source.time("force.ramp_s", number, duration_s)?,
                None => 0.0,
            },
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

/// The display's first set-point must be one that it may take.
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

//! Lines to commands.

use contact_model::fixed_point::ContactPair;
use contact_model::material::{MATERIALS, Material, SKIN, Surface};
use fixed::types::I32F32;

use thermal_commissioning::{Request, StorageOrder};
use thermal_device::TICK_HZ;
use thermal_device::command::Command;
use thermal_device::control::Law;
use thermal_device::reference::Mode;
use thermal_device::safety::Setpoint;
use thermal_settings::{Range, Settings};

use crate::Error;
use crate::commissioning;

/// A line of the host, checked and ready to execute.
#[derive(Clone, Debug, PartialEq)]
pub enum Parsed {
    /// `id`: who is there.
    Identify,
    /// For the stations.
    Station(Command),
    /// For the commissioning sessions.
    Commissioning(Request),
    /// `save` or `forget`, for the device as a whole.
    Storage(StorageOrder),
}

impl Parsed {
    /// Words that begin a command.
    pub const WORDS: [&'static str; 20] = [
        "id",
        "state",
        "stream",
        "material",
        "object",
        "mode",
        "law",
        "arm",
        "hold",
        "start",
        "abort",
        "clear",
        "cause",
        "calibrate",
        "tune",
        "margins",
        "settings",
        "set",
        "save",
        "forget",
    ];

    /// Reads one line. Does the costly part of a command (soft-float set-up of a material), so that
    /// executing it is short.
    ///
    /// # Errors
    /// What is wrong with the line, and what is allowed.
    pub fn parse(line: &str, settings: &Settings) -> Result<Self, Error> {
        let mut words = line.split_ascii_whitespace();
        let first = words.next().ok_or(Error::Missing("command"))?;
        let parsed = match first {
            "id" => Self::Identify,
            "state" => Self::Station(Command::Status),
            "arm" => Self::Station(Command::Arm),
            "start" => Self::Station(Command::Start),
            "abort" => Self::Station(Command::Abort),
            "clear" => Self::Station(Command::Clear),
            "cause" => Self::Station(Command::Cause),
            "tune" => match words.next() {
                None => Self::Station(Command::Tune),
                Some("result") => Self::Commissioning(Request::Tuned),
                Some(other) => return Err(Error::Extra(other.into())),
            },
            "calibrate" => Self::Commissioning(commissioning::calibrate(&mut words)?),
            "settings" => Self::Commissioning(commissioning::settings(&mut words)?),
            "set" => Self::Commissioning(commissioning::set(&mut words)?),
            "margins" => Self::Commissioning(Request::Margins),
            "save" => Self::Storage(StorageOrder::Save),
            "forget" => Self::Storage(StorageOrder::Forget),
            "hold" => Self::Station(Command::Hold(hold(number(&mut words, &HOLD)?))),
            "stream" => {
                // A part of a millisecond counts as a whole one, so that only 0 ends the stream.
                let interval_ms = number(&mut words, &STREAM)?.saturating_ceil();
                Self::Station(Command::Stream {
                    interval_ms: interval_ms.to_num::<i64>().unsigned_abs() as u32,
                })
            }
            "mode" => match words.next().ok_or(Error::Missing("mode"))? {
                "contact" => Self::Station(Command::Mode(Mode::ContactResistance)),
                "semi-infinite" => Self::Station(Command::Mode(Mode::SemiInfinite)),
                other => return Err(Error::UnknownMode(other.into())),
            },
            "law" => Self::Station(Command::Law(words.next().map(law).transpose()?)),
            "object" => match words.clone().next() {
                Some("room") => {
                    words.next();
                    Self::Station(Command::Object(None))
                }
                _ => Self::Station(Command::Object(Some(number(&mut words, &OBJECT)?.to_num()))),
            },
            "material" => {
                let name = words.next().ok_or(Error::Missing("material"))?;
                let (name, material) = if name == "custom" {
                    ("custom", custom(&mut words)?)
                } else {
                    let known = MATERIALS.iter().find(|(known, _)| *known == name);
                    known
                        .map(|(name, material)| (*name, *material))
                        .ok_or(Error::UnknownMaterial(name.into()))?
                };
                Self::Station(Command::Material {
                    name,
                    pair: pair(&material, &settings.display)?,
                })
            }
            other => return Err(Error::UnknownCommand(other.into())),
        };
        match words.next() {
            None => Ok(parsed),
            Some(extra) => Err(Error::Extra(extra.into())),
        }
    }
}

static STREAM: Range = Range {
    name: "interval",
    unit: "ms",
    min: 0.0,
    max: 60_000.0,
};
/// The range of [`Setpoint`].
static HOLD: Range = Range {
    name: "temperature",
    unit: "C",
    min: 15.0,
    max: 42.0,
};
static OBJECT: Range = Range {
    name: "object temperature",
    unit: "C",
    min: -20.0,
    max: 60.0,
};
/// The properties of a custom material, in their order on the line.
static PROPERTIES: [Range; 5] = [
    Range {
        name: "conductivity",
        unit: "W/mK",
        min: 0.001,
        max: 5000.0,
    },
    Range {
        name: "density",
        unit: "kg/m3",
        min: 1.0,
        max: 30_000.0,
    },
    Range {
        name: "specific heat",
        unit: "J/kgK",
        min: 10.0,
        max: 10_000.0,
    },
    Range {
        name: "roughness",
        unit: "um",
        min: 0.001,
        max: 1000.0,
    },
    Range {
        name: "slope",
        unit: "rad",
        min: 0.0001,
        max: 1.5,
    },
];

/// Takes the next word as a decimal number within its range.
pub(crate) fn number<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    expected: &'static Range,
) -> Result<I32F32, Error> {
    let word = words.next().ok_or(Error::Missing(expected.name))?;
    // Saturates, so that too many digits are out of range.
    let value =
        I32F32::saturating_from_str(word).map_err(|_| Error::NotANumber(expected, word.into()))?;
    let range = I32F32::from_num(expected.min)..=I32F32::from_num(expected.max);
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(Error::OutOfRange(expected, word.into()))
    }
}

fn hold(celsius: I32F32) -> Setpoint {
    Setpoint::limited(celsius.to_num()).0
}

fn law(name: &str) -> Result<Law, Error> {
    let known = Law::WORDS.iter().find(|(known, _)| *known == name);
    known
        .map(|(_, law)| *law)
        .ok_or(Error::UnknownLaw(name.into()))
}

fn custom<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<Material, Error> {
    let mut values = [0.0; PROPERTIES.len()];
    for (value, property) in values.iter_mut().zip(&PROPERTIES) {
        *value = number(words, property)?.to_num();
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
    Ok(Material {
        surface,
        density_kg_m3,
        specific_heat_j_kgk,
    })
}

fn pair(material: &Material, display: &Surface) -> Result<ContactPair, Error> {
    ContactPair::new(&SKIN, material, display, 1.0 / f64::from(TICK_HZ)).map_err(Error::ContactPair)
}

//! Lines to commands.

use contact_model::fixed_point::{Celsius, ContactPair};
use contact_model::material::{MATERIALS, Material, SKIN, Surface};
use fixed::types::I32F32;

use super::Error;
use super::error::Number;
use crate::TICK_HZ;
use crate::control::{Law, Tuned};
use crate::guard::Setpoint;
use crate::render::Mode;
use crate::sense::Calibrated;
use crate::settings::Settings;

/// A command of the host, checked and ready to execute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// `id`: who is there.
    Identify,
    /// `state`: what the device is doing.
    Status,
    /// `stream MS`: telemetry every so many milliseconds; 0 ends it.
    Stream {
        /// Interval, ms.
        interval_ms: u32,
    },
    /// `material NAME`, or `material custom K RHO C RQ SLOPE` in W/(m K), kg/m³, J/(kg K), µm and rad.
    Material {
        /// Name, or `custom`.
        name: &'static str,
        /// The material under a finger on this display.
        pairing: ContactPair,
    },
    /// `object CELSIUS` or `object room`: temperature of the object before contact.
    Object(Option<Celsius>),
    /// `mode contact` or `mode semi-infinite`.
    Mode(Mode),
    /// `law model`, `law pi` or `law pi-10hz`: what finds the current; `law`: what does now.
    Law(Option<Law>),
    /// `arm`: drive the display to skin temperature.
    Arm,
    /// `hold CELSIUS`: drive the display to a temperature.
    Hold(Setpoint),
    /// `start`: the object appears.
    Start,
    /// `abort`: bridge off.
    Abort,
    /// `clear`: take back a fault that is no longer present.
    Clear,
    /// `cause`: why it tripped, now or the last time.
    Cause,
    /// What a thermistor's sums are on average, for [`Desk`](crate::commission::Desk).
    Average(usize),
    /// `tune`: find out what the tile is like.
    Tune,
    /// A row of what that has shown, for [`Desk`](crate::commission::Desk).
    Experiment(usize),
    /// Reads by another calibration, from it.
    Calibrate(Calibrated),
    /// Controls another tile, from it.
    Retune(Tuned),
}

impl Command {
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
        let command = match first {
            "id" => Self::Identify,
            "state" => Self::Status,
            "arm" => Self::Arm,
            "start" => Self::Start,
            "abort" => Self::Abort,
            "clear" => Self::Clear,
            "cause" => Self::Cause,
            "tune" => Self::Tune,
            "hold" => Self::Hold(hold(number(&mut words, &HOLD)?)),
            "stream" => {
                // A part of a millisecond counts as a whole one, so that only 0 ends the stream.
                let interval_ms = number(&mut words, &STREAM)?.saturating_ceil();
                Self::Stream {
                    interval_ms: interval_ms.to_num::<i64>().unsigned_abs() as u32,
                }
            }
            "mode" => match words.next().ok_or(Error::Missing("mode"))? {
                "contact" => Self::Mode(Mode::ContactResistance),
                "semi-infinite" => Self::Mode(Mode::SemiInfinite),
                other => return Err(Error::UnknownMode(other.into())),
            },
            "law" => Self::Law(words.next().map(law).transpose()?),
            "object" => match words.clone().next() {
                Some("room") => {
                    words.next();
                    Self::Object(None)
                }
                _ => Self::Object(Some(number(&mut words, &OBJECT)?.to_num())),
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
                Self::Material {
                    name,
                    pairing: pair(&material, &settings.display)?,
                }
            }
            other => return Err(Error::UnknownCommand(other.into())),
        };
        match words.next() {
            None => Ok(command),
            Some(extra) => Err(Error::Extra(extra.into())),
        }
    }
}

static STREAM: Number = Number {
    name: "interval",
    unit: "ms",
    min: 0.0,
    max: 60_000.0,
};
/// The range of [`Setpoint`].
static HOLD: Number = Number {
    name: "temperature",
    unit: "C",
    min: 15.0,
    max: 42.0,
};
static OBJECT: Number = Number {
    name: "object temperature",
    unit: "C",
    min: -20.0,
    max: 60.0,
};
/// The properties of a custom material, in their order on the line.
static PROPERTIES: [Number; 5] = [
    Number {
        name: "conductivity",
        unit: "W/mK",
        min: 0.001,
        max: 5000.0,
    },
    Number {
        name: "density",
        unit: "kg/m3",
        min: 1.0,
        max: 30_000.0,
    },
    Number {
        name: "specific heat",
        unit: "J/kgK",
        min: 10.0,
        max: 10_000.0,
    },
    Number {
        name: "roughness",
        unit: "um",
        min: 0.001,
        max: 1000.0,
    },
    Number {
        name: "slope",
        unit: "rad",
        min: 0.0001,
        max: 1.5,
    },
];

/// Takes the next word as a decimal number within its range.
pub(crate) fn number<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    expected: &'static Number,
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

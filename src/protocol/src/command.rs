//! Parsing of a line to a request.

use contact_model::fixed_point::{Celsius, ContactPair};
use contact_model::material::{MATERIALS, Material, SKIN, Surface};

use thermal_commissioning::{SessionRequest, StorageOrder};
use thermal_device::TICK_HZ;
use thermal_device::command::Command;
use thermal_device::control::Law;
use thermal_device::reference::Mode;
use thermal_device::safety::Setpoint;
use thermal_device::safety::limits::{SETPOINT_MAX_C, SETPOINT_MIN_C};
use thermal_settings::{Range, Settings};

use crate::Error;
use crate::arguments::{Words, lookup, number, numbers, skip, word};
use crate::commissioning_commands::{calibrate, set, settings};

/// A line of the host, checked and ready to execute.
#[allow(
    clippy::large_enum_variant,
    reason = "no heap to box the larger one in"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// `id`: reports what the device is.
    Identify,
    /// A command for the stations.
    Station(Command),
    /// A request to the commissioning sessions.
    Commissioning(SessionRequest),
    /// `save` or `forget`: an order for the device as a whole.
    Storage(StorageOrder),
}

/// Declares the commands, each by its first word and the expression that reads its arguments: once for the parser, and
/// once for the list of known commands in an error message.
macro_rules! commands {
    (|$words:ident, $display:ident| { $($name:literal => $request:expr,)* }) => {
        /// First words of all commands.
        pub const WORDS: &[&str] = &[$($name),*];

        fn parse_arguments(
            name: &str,
            $words: &mut Words<'_>,
            $display: &Surface,
        ) -> Result<Self, Error> {
            Ok(match name {
                $($name => $request,)*
                unknown => return Err(Error::UnknownCommand(unknown.into())),
            })
        }
    };
}

impl Request {
    commands!(|words, display| {
        "id" => Self::Identify,
        "state" => Self::Station(Command::Status),
        "stream" => Self::Station(stream(words)?),
        "material" => Self::Station(material(words, display)?),
        "object" => Self::Station(Command::Object(object(words)?)),
        "mode" => Self::Station(Command::Mode(mode(words)?)),
        "law" => Self::Station(Command::Law(words.next().map(law).transpose()?)),
        "arm" => Self::Station(Command::Arm),
        "hold" => Self::Station(Command::Hold(hold(words)?)),
        "start" => Self::Station(Command::Start),
        "abort" => Self::Station(Command::Abort),
        "clear" => Self::Station(Command::Clear),
        "cause" => Self::Station(Command::Cause),
        "calibrate" => Self::Commissioning(calibrate(words)?),
        "tune" => match skip(words, "result") {
            true => Self::Commissioning(SessionRequest::TuneResult),
            false => Self::Station(Command::Tune),
        },
        "margins" => Self::Commissioning(SessionRequest::Margins),
        "settings" => Self::Commissioning(settings(words)?),
        "set" => Self::Commissioning(SessionRequest::Set(set(words)?)),
        "save" => Self::Storage(StorageOrder::Save),
        "forget" => Self::Storage(StorageOrder::Forget),
    });

    /// Parses one line. The costly part of a command, the floating-point set-up of a material, is done here, so that
    /// executing the request takes a short time.
    ///
    /// # Errors
    /// The line is no request; the error says what is wrong with it and what is allowed.
    pub fn parse(line: &str, settings: &Settings) -> Result<Self, Error> {
        let mut words = line.split_ascii_whitespace();
        let name = word(&mut words, "command")?;
        let request = Self::parse_arguments(name, &mut words, &settings.display)?;
        match words.next() {
            None => Ok(request),
            Some(extra) => Err(Error::Extra(extra.into())),
        }
    }
}

/// Words of the modes.
pub const MODES: [(&str, Mode); 2] = [
    ("contact", Mode::ContactResistance),
    ("semi-infinite", Mode::SemiInfinite),
];
/// Word of a material that is given by its properties.
pub const CUSTOM: &str = "custom";

static STREAM: Range = Range {
    name: "interval",
    unit: "ms",
    min: 0.0,
    max: 60_000.0,
};
static HOLD: Range = Range {
    name: "temperature",
    unit: "C",
    min: SETPOINT_MIN_C,
    max: SETPOINT_MAX_C,
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

fn stream(words: &mut Words<'_>) -> Result<Command, Error> {
    // Rounds a fraction of a millisecond up, so that only 0 ends the stream.
    let interval_ms = number(words, &STREAM)?.saturating_ceil().to_num::<i64>();
    Ok(Command::Stream {
        interval_ms: interval_ms.unsigned_abs() as u32,
    })
}

fn object(words: &mut Words<'_>) -> Result<Option<Celsius>, Error> {
    if skip(words, "room") {
        return Ok(None);
    }
    Ok(Some(number(words, &OBJECT)?.to_num()))
}

fn mode(words: &mut Words<'_>) -> Result<Mode, Error> {
    let name = word(words, "mode")?;
    let (_, mode) = lookup(&MODES, name).ok_or(Error::UnknownMode(name.into()))?;
    Ok(mode)
}

fn law(name: &str) -> Result<Law, Error> {
    let (_, law) = lookup(&Law::PROTOCOL_WORDS, name).ok_or(Error::UnknownLaw(name.into()))?;
    Ok(law)
}

fn hold(words: &mut Words<'_>) -> Result<Setpoint, Error> {
    let celsius = number(words, &HOLD)?.to_num();
    Ok(Setpoint::limited(celsius).0)
}

fn material(words: &mut Words<'_>, display: &Surface) -> Result<Command, Error> {
    let name = word(words, "material")?;
    let (name, material) = if name == CUSTOM {
        (CUSTOM, custom_material(words)?)
    } else {
        lookup(&MATERIALS, name).ok_or(Error::UnknownMaterial(name.into()))?
    };
    let pair = ContactPair::new(&SKIN, &material, display, 1.0 / f64::from(TICK_HZ))
        .map_err(Error::ContactPair)?;
    Ok(Command::Material { name, pair })
}

fn custom_material(words: &mut Words<'_>) -> Result<Material, Error> {
    let [
        conductivity_w_mk,
        density_kg_m3,
        specific_heat_j_kgk,
        roughness_um,
        slope_rad,
    ] = numbers(words, &PROPERTIES)?;
    Ok(Material {
        surface: Surface {
            conductivity_w_mk,
            roughness_um,
            slope_rad,
        },
        density_kg_m3,
        specific_heat_j_kgk,
    })
}

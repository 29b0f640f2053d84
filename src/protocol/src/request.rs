//! Parsing of a line from the host to a request.

use contact_model::contact_law::ContactLaw;
use contact_model::material::{MATERIALS, Material, Surface};
use contact_model::slab::Back;
use fixed::types::I32F32;

use thermal_commissioning::{SessionRequest, StorageOrder};
use thermal_device::command::{AssumedFinger, ChosenContactLaw, ChosenMaterial, Command};
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_settings::{Range, Settings};

use crate::Error;
use crate::arguments::{
    Words, expect_end, read_fixed_point_in_range, read_numbers_in_ranges, read_word,
    skip_if_next_is, table_entry_for_word_or_none, word_or_empty,
};
use crate::calibrate_settings_set_commands::{
    parse_calibration_point_or_clear, parse_flux, parse_set_arguments, parse_settings_query,
    parse_surface,
};
use crate::events::{parse_switch, parse_telemetry_fields, parse_trigger_output};
use crate::object::parse_object;
use crate::person::{PersonRequest, parse_forget, parse_person};
use crate::stimulus::{Pulse, parse_hold, parse_play, parse_pulse, parse_skin};

/// A line from the host after parsing: a command with its arguments, which are within their ranges.
#[allow(clippy::large_enum_variant, reason = "no heap to box the larger one in")]
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// The line `id`: report name and version of the firmware, number of fingers, tick rate and scan rate.
    Identify,
    /// The line `checksum on` or `checksum off`: whether lines end with a checksum.
    Checksum(bool),
    /// The line `board`: report the state of microcontroller and serial line.
    Board,
    /// A line that the stations (the control) of the addressed fingers execute as this command, such as `arm` or
    /// `material`.
    Station(Command<'static>),
    /// The line `object slab ...`: the object is a slab of the chosen material.
    Slab {
        /// Its thickness, mm.
        thickness_mm: f64,
        /// What is behind it.
        back: Back,
    },
    /// The line `pulse ...`: load a course of four points, and play it.
    Pulse(Pulse),
    /// A line `upload`: begin, a row, or commit.
    Upload,
    /// A line about settings or calibration, which the commissioning sessions of the addressed fingers execute:
    /// `calibrate`, `tune result`, `margins`, `settings`, `set`, `flux` or `surface`.
    Commissioning(SessionRequest),
    /// A line about persons: `person`, `persons` or `forget person`.
    Person(PersonRequest),
    /// The line `save` or `forget`: store the present settings of all fingers, or factory defaults, in flash.
    Storage(StorageOrder),
}

/// Generates the parser of the commands' arguments, and the list of commands in the answer to an unknown command, from
/// one list: each entry is the first word of a command and the expression that reads its arguments.
macro_rules! commands {
    (|$words:ident, $display:ident| { $($name:literal => $request:expr,)* }) => {
        /// First words of all commands, which the answer to an unknown command lists.
        pub const KNOWN_COMMAND_WORDS: &[&str] = &[$($name),*];

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
        "board" => Self::Board,
        "state" => Self::Station(Command::Status),
        "stream" => Self::Station(parse_stream(words)?),
        "events" => Self::Station(Command::ReportEvents(parse_switch(words, "events")?)),
        "trigger-out" => Self::Station(Command::TriggerOutput(parse_trigger_output(words)?)),
        "checksum" => Self::Checksum(parse_switch(words, "checksum")?),
        "material" => Self::Station(parse_material_and_compute_contact(words, display)?),
        "object" => parse_object(words)?,
        "finger" => Self::Station(Command::Finger(words.next().map(parse_finger).transpose()?)),
        "contact" => Self::Station(Command::ContactLaw(parse_contact_law(words)?)),
        "person" => parse_person(words)?,
        "persons" => Self::Person(PersonRequest::List),
        "upload" => Self::Upload,
        "mode" => Self::Station(Command::Mode(parse_contact_model(words)?)),
        "law" => Self::Station(Command::Law(words.next().map(parse_control_law_word).transpose()?)),
        "arm" => Self::Station(Command::Arm),
        "hold" => Self::Station(parse_hold(words)?),
        "play" => Self::Station(Command::Play(parse_play(words)?)),
        "pulse" => Self::Pulse(parse_pulse(words)?),
        "skin" => Self::Station(Command::AssumeSkin(parse_skin(words)?)),
        "start" => Self::Station(Command::Start),
        "abort" => Self::Station(Command::Abort),
        "clear" => Self::Station(Command::Clear),
        "cause" => Self::Station(Command::Cause),
        "self-test" => Self::Station(Command::SelfTest),
        "raw" => Self::Station(Command::Raw),
        "calibrate" => Self::Commissioning(parse_calibration_point_or_clear(words)?),
        "tune" => match skip_if_next_is(words, "result") {
            true => Self::Commissioning(SessionRequest::TuneResult),
            false => Self::Station(Command::Tune),
        },
        "margins" => Self::Commissioning(SessionRequest::Margins),
        "settings" => Self::Commissioning(parse_settings_query(words)?),
        "set" => Self::Commissioning(SessionRequest::Set(parse_set_arguments(words)?)),
        "flux" => Self::Commissioning(parse_flux(words)?),
        "surface" => Self::Commissioning(parse_surface(words)?),
        "save" => Self::Storage(StorageOrder::Save),
        "forget" => parse_forget(words)?,
    });

    /// Parses a line from the host without its address. `settings` give the surface of the display, on which the
    /// contact with a material depends. The floating-point constants of that contact take long to compute, so they are
    /// computed here and not when the request is executed, while the control tick is locked out.
    ///
    /// # Errors
    /// The line is no valid request; the error says what is wrong with it and what is allowed.
    #[inline(never)]
    pub fn parse(line: &str, settings: &Settings) -> Result<Self, Error> {
        let mut words = line.split_ascii_whitespace();
        let name = read_word(&mut words, "command")?;
        let request = Self::parse_arguments(name, &mut words, settings.display.surface())?;
        if matches!(request, Self::Upload) {
            // Its arguments depend on the upload so far.
            return Ok(request);
        }
        expect_end(&mut words)?;
        Ok(request)
    }
}

/// Arguments of the command `mode`, each with the contact model that it selects: `contact` takes the thermal contact
/// resistance between skin and object into account, `semi-infinite` does not. The contact model gives the set-point.
pub const CONTACT_MODEL_WORDS: [(&str, ContactModel); 2] =
    [("contact", ContactModel::ContactResistance), ("semi-infinite", ContactModel::SemiInfinite)];
/// Arguments of the commands `checksum` and `events`.
pub const SWITCH_WORDS: [(&str, bool); 2] = [("on", true), ("off", false)];
/// Argument of the command `material` in place of a material's name. The properties of the material follow:
/// conductivity (W/mK), density (kg/m³), specific heat (J/kgK), roughness (µm) and slope of the asperities (rad).
pub const CUSTOM_MATERIAL_WORD: &str = "custom";

/// Argument of the command `contact` for the contact law of Eq. 6-8, in place of the three values of another one.
pub const NOMINAL_CONTACT_LAW_WORD: &str = "nominal";

static CONTACT_LAW_RANGES: [Range; 3] = [
    Range {
        name: "exponent",
        unit: "",
        min: *ContactLaw::EXPONENTS.start(),
        max: *ContactLaw::EXPONENTS.end(),
    },
    Range {
        name: "microhardness",
        unit: "Pa",
        min: *ContactLaw::HARDNESSES_PA.start(),
        max: *ContactLaw::HARDNESSES_PA.end(),
    },
    Range {
        name: "gap",
        unit: "W/(m2 K)",
        min: *ContactLaw::GAPS_W_M2K.start(),
        max: *ContactLaw::GAPS_W_M2K.end(),
    },
];
static STREAM_INTERVAL_RANGE: Range =
    Range { name: "interval", unit: "ms", min: 0.0, max: 60_000.0 };
/// Allowed ranges of the properties of a material in the line `material custom ...`, in their order on the line:
/// thermal conductivity, density, specific heat, roughness and slope of the asperities.
static MATERIAL_PROPERTY_RANGES: [Range; 5] = [
    Range { name: "conductivity", unit: "W/mK", min: 0.001, max: 5000.0 },
    Range { name: "density", unit: "kg/m3", min: 1.0, max: 30_000.0 },
    Range { name: "specific heat", unit: "J/kgK", min: 10.0, max: 10_000.0 },
    Range { name: "roughness", unit: "um", min: 0.001, max: 1000.0 },
    Range { name: "slope", unit: "rad", min: 0.0001, max: 1.5 },
];

fn parse_stream(words: &mut Words<'_>) -> Result<Command<'static>, Error> {
    // Rounds a fraction of a millisecond up, so that only 0 ends the stream.
    let interval_ms =
        read_fixed_point_in_range(words, &STREAM_INTERVAL_RANGE)?.saturating_ceil().to_bits()
            >> I32F32::FRAC_NBITS;
    Ok(Command::Stream { interval_ms: interval_ms as u32, fields: parse_telemetry_fields(words)? })
}

fn parse_finger(name: &str) -> Result<AssumedFinger, Error> {
    let found = table_entry_for_word_or_none(&AssumedFinger::PROTOCOL_WORDS, name);
    let (_, finger) = found.ok_or(Error::UnknownAssumedFinger(name.into()))?;
    Ok(finger)
}

fn parse_contact_law(words: &mut Words<'_>) -> Result<Option<ChosenContactLaw>, Error> {
    if words.clone().next().is_none() {
        return Ok(None);
    }
    if skip_if_next_is(words, NOMINAL_CONTACT_LAW_WORD) {
        return Ok(Some(ChosenContactLaw::NOMINAL));
    }
    let [exponent, hardness_pa, gap_w_m2k] = read_numbers_in_ranges(words, &CONTACT_LAW_RANGES)?;
    Ok(Some(ChosenContactLaw::new(ContactLaw { exponent, hardness_pa, gap_w_m2k })))
}

fn parse_contact_model(words: &mut Words<'_>) -> Result<ContactModel, Error> {
    let name = word_or_empty(words);
    let (_, mode) = table_entry_for_word_or_none(&CONTACT_MODEL_WORDS, name)
        .ok_or(Error::UnknownMode(name.into()))?;
    Ok(mode)
}

fn parse_control_law_word(name: &str) -> Result<Law, Error> {
    let (_, law) = table_entry_for_word_or_none(&Law::PROTOCOL_WORDS, name)
        .ok_or(Error::UnknownLaw(name.into()))?;
    Ok(law)
}

fn parse_material_and_compute_contact(
    words: &mut Words<'_>,
    display: &Surface,
) -> Result<Command<'static>, Error> {
    let name = word_or_empty(words);
    let (name, material) = if name == CUSTOM_MATERIAL_WORD {
        (CUSTOM_MATERIAL_WORD, parse_custom_material_properties(words)?)
    } else {
        table_entry_for_word_or_none(&MATERIALS, name).ok_or(Error::UnknownMaterial(name.into()))?
    };
    let chosen = ChosenMaterial::new(name, &material, display).map_err(Error::ContactPair)?;
    Ok(Command::Material(chosen))
}

fn parse_custom_material_properties(words: &mut Words<'_>) -> Result<Material, Error> {
    let [conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad] =
        read_numbers_in_ranges(words, &MATERIAL_PROPERTY_RANGES)?;
    Ok(Material {
        surface: Surface { conductivity_w_mk, roughness_um, slope_rad },
        density_kg_m3,
        specific_heat_j_kgk,
    })
}

//! Commands whose answer is `ok` alone.

use std::fmt;

use contact_model::contact_law::ContactLaw;
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::Material;
use contact_model::slab::Back;
use thermal_commissioning::{StorageOrder, THERMISTOR_WORDS};
use thermal_device::TelemetryFields;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::events::DeviceEventKind;
use thermal_device::reference::ContactModel;
use thermal_device::safety::ThermistorId;
use thermal_device::stimulus::{CourseEnd, PlayOrder, TemperatureKind};
use thermal_protocol::{CONTACT_MODEL_WORDS, CUSTOM_MATERIAL_WORD, NOMINAL_CONTACT_LAW_WORD};
use thermal_wire::telemetry::{DEFAULT_FIELDS, NAMES, NO_FIELDS, place_of_field};
use thermal_settings::{CRC_32, DisplaySurface, FluxSensor, Person, PersonCode};

use super::person::person_data;
use super::reply::SettingsLine;
use super::{Command, Fields};

/// Square millimetres, in which the protocol counts areas, per square metre.
const MM2_PER_M2: f64 = 1e6;

/// A command whose answer is `ok` alone.
#[derive(Clone, Debug, PartialEq)]
pub enum PlainCommand {
    /// Choose the object's material by its name.
    Material(String),
    /// Choose the object's material by its properties.
    CustomMaterial(Material),
    /// Choose the object's temperature before contact, °C; `None` for that of the room.
    ObjectTemperature(Option<f64>),
    /// The object is an endless block of its material.
    HalfSpace,
    /// The object is a slab of its material.
    Slab {
        /// Thickness, mm.
        thickness_mm: f64,
        /// What is behind it.
        back: Back,
    },
    /// Choose the finger that the device assumes for the one that touches.
    AssumedFinger(AssumedFinger),
    /// Take this for the finger's contact law: `contact nominal` if it is that of Eq. 6-8.
    ContactLaw(ContactLaw),
    /// Choose the contact model.
    Mode(ContactModel),
    /// Choose the control law.
    Law(Law),
    /// Run the self-test if it has not been passed, then drive the display to skin temperature.
    Arm,
    /// Present the object.
    Start,
    /// Switch the bridge off.
    Abort,
    /// Clear a fault that is no longer present.
    Clear,
    /// Telemetry at this interval, ms, with these fields; an interval of 0 ends it.
    Stream(u32, TelemetryFields),
    /// Checksums on the lines from the device from now on, or not.
    Checksum(bool),
    /// Move the set-point to this temperature, °C, at this rate, K/s, or without one at the device's own, and hold it.
    Hold(f64, Option<f64>),
    /// Play the loaded course.
    Play(PlayOrder),
    /// Load and play a course of four points.
    Pulse {
        /// First and last temperature, °C.
        base_c: f64,
        /// Temperature that is held, °C.
        target_c: f64,
        /// Rate to it, K/s.
        rise_k_s: f64,
        /// How long it is held, s.
        hold_s: f64,
        /// Rate back, K/s.
        return_k_s: f64,
        /// When it begins.
        order: PlayOrder,
    },
    /// Assume this temperature of the skin, °C, or that of the sensor.
    Skin(Option<f64>),
    /// Report events, or none.
    Events(bool),
    /// Mark these events at the trigger output; none of them switches it off.
    TriggerOutput(Vec<DeviceEventKind>),
    /// Begin to identify the tile.
    Tune,
    /// Delete calibration points and correction of a thermistor.
    ClearCalibration(ThermistorId),
    /// Replace settings.
    Set(SettingsLine),
    /// Use this heat-flux sensor, or none.
    FluxSensor(Option<FluxSensor>),
    /// Take the zero of the heat-flux sensor.
    FluxZero,
    /// The display has this surface.
    DisplaySurface(DisplaySurface),
    /// The finger is that of this person, or of an unknown one.
    ChoosePerson(Option<PersonCode>),
    /// Store a person.
    StorePerson(Person),
    /// Forget a person.
    ForgetPerson(PersonCode),
    /// Restart, and store the settings or the factory defaults.
    Store(StorageOrder),
    /// Begin an upload: number of rows, direct term in m² K/W.
    UploadBegin(usize, f64),
    /// A row of an upload by its index.
    UploadRow(usize, Relaxation),
    /// Begin the upload of a course: number of points, and what its temperatures are.
    UploadCourse(usize, TemperatureKind),
    /// A point of a course by its index: time, s, and temperature, °C or K above the skin.
    UploadPoint(usize, f64, f64),
    /// End an upload with the checksum of its lines.
    UploadCommit(u32),
}

/// The thermistors in the order of their words.
pub const THERMISTORS: [ThermistorId; THERMISTOR_WORDS.len()] = [
    ThermistorId::Display,
    ThermistorId::Check,
    ThermistorId::Sink,
    ThermistorId::Skin,
    ThermistorId::Room,
];

/// The thermistor with a word.
pub fn thermistor(word: &str) -> Option<ThermistorId> {
    let mut all = THERMISTORS.into_iter();
    all.find(|thermistor| thermistor_word(*thermistor) == word)
}

/// Word of a thermistor on the line.
pub const fn thermistor_word(thermistor: ThermistorId) -> &'static str {
    THERMISTOR_WORDS[thermistor as usize]
}

impl PlainCommand {
    /// Telemetry at this interval, ms, with the default fields; 0 ends it.
    pub const fn stream(interval_ms: u32) -> Self {
        Self::Stream(interval_ms, DEFAULT_FIELDS)
    }

    /// The same of a finger with a heat-flux sensor, with the sensor's fields. A line to the device has no room for all names, so
    /// the count of evaluations is left out, which says nothing of the finger.
    pub fn stream_with_flux(interval_ms: u32) -> Self {
        let names: Vec<_> = NAMES.into_iter().filter(|name| *name != "evaluations").collect();
        Self::stream_fields(interval_ms, &names)
    }

    /// Telemetry at this interval, ms, with the fields of these names ([`NAMES`]).
    pub fn stream_fields(interval_ms: u32, names: &[&str]) -> Self {
        let known = names.iter().filter_map(|name| place_of_field(name));
        Self::Stream(interval_ms, known.fold(NO_FIELDS, TelemetryFields::with))
    }
}

impl fmt::Display for PlainCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Material(name) => write!(f, "material {name}"),
            Self::CustomMaterial(material) => {
                let surface = &material.surface;
                write!(
                    f,
                    "material {CUSTOM_MATERIAL_WORD} {} {} {} {} {}",
                    surface.conductivity_w_mk,
                    material.density_kg_m3,
                    material.specific_heat_j_kgk,
                    surface.roughness_um,
                    surface.slope_rad
                )
            }
            Self::ObjectTemperature(Some(celsius)) => write!(f, "object {celsius}"),
            Self::ObjectTemperature(None) => f.write_str("object room"),
            Self::HalfSpace => f.write_str("object half-space"),
            Self::Slab { thickness_mm, back } => {
                write!(f, "object slab {thickness_mm}mm ")?;
                match back {
                    Back::Insulated => f.write_str("insulated"),
                    Back::Held => f.write_str("held"),
                    Back::Film(film_w_m2k) => write!(f, "film {film_w_m2k}"),
                }
            }
            Self::AssumedFinger(finger) => write!(f, "finger {}", finger.name()),
            Self::ContactLaw(ContactLaw::NOMINAL) => {
                write!(f, "contact {NOMINAL_CONTACT_LAW_WORD}")
            }
            Self::ContactLaw(law) => {
                write!(f, "contact {:.4} {:.0} {:.1}", law.exponent, law.hardness_pa, law.gap_w_m2k)
            }
            Self::Mode(mode) => {
                write!(f, "mode {}", word_in(&CONTACT_MODEL_WORDS, mode))
            }
            Self::Law(law) => write!(f, "law {}", law.name()),
            Self::Arm => f.write_str("arm"),
            Self::Start => f.write_str("start"),
            Self::Abort => f.write_str("abort"),
            Self::Clear => f.write_str("clear"),
            Self::Checksum(on) => f.write_str(if *on { "checksum on" } else { "checksum off" }),
            Self::Hold(celsius, None) => write!(f, "hold {celsius}"),
            Self::Hold(celsius, Some(rate_k_s)) => write!(f, "hold {celsius} {rate_k_s}"),
            Self::Play(order) => {
                f.write_str("play ")?;
                write_order(f, order)
            }
            Self::Pulse { base_c, target_c, rise_k_s, hold_s, return_k_s, order } => {
                write!(f, "pulse {base_c} {target_c} {rise_k_s} {hold_s} {return_k_s} ")?;
                write_order(f, order)
            }
            Self::Skin(Some(celsius)) => write!(f, "skin {celsius}"),
            Self::Skin(None) => f.write_str("skin sensor"),
            Self::Events(on) => f.write_str(if *on { "events on" } else { "events off" }),
            Self::TriggerOutput(kinds) if kinds.is_empty() => f.write_str("trigger-out none"),
            Self::TriggerOutput(kinds) => {
                let words: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
                write!(f, "trigger-out {}", words.join(","))
            }
            Self::Stream(interval_ms, fields) => {
                write!(f, "stream {interval_ms}")?;
                if *fields == DEFAULT_FIELDS {
                    return Ok(());
                }
                let names = NAMES.iter().enumerate();
                let mut chosen = names.filter(|(index, _)| fields.contains(*index));
                chosen.try_for_each(|(_, name)| write!(f, " {name}"))
            }
            Self::UploadCourse(count, temperatures) => {
                let word = word_in(&TemperatureKind::PROTOCOL_WORDS, temperatures);
                write!(f, "upload begin course {count} {word}")
            }
            Self::UploadPoint(index, time_s, temperature) => {
                write!(f, "upload row {index} {time_s:.3} {temperature:.6}")
            }
            Self::Tune => f.write_str("tune"),
            Self::ClearCalibration(thermistor) => {
                write!(f, "calibrate {} clear", thermistor_word(*thermistor))
            }
            Self::Set(line) => line.fmt(f),
            Self::FluxSensor(None) => f.write_str("flux none"),
            Self::FluxSensor(Some(sensor)) => {
                f.write_str("flux set")?;
                let mut values = sensor.to_array().into_iter();
                values.try_for_each(|value| write!(f, " {value}"))
            }
            Self::FluxZero => f.write_str("flux zero"),
            Self::DisplaySurface(DisplaySurface::NOMINAL) => f.write_str("surface nominal"),
            Self::DisplaySurface(surface) => {
                f.write_str("surface set")?;
                let mut values = surface.to_array().into_iter();
                values.try_for_each(|value| write!(f, " {value}"))
            }
            Self::ChoosePerson(None) => f.write_str("person none"),
            Self::ChoosePerson(Some(code)) => write!(f, "person {code}"),
            Self::StorePerson(person) => {
                write!(f, "person {} {}", person.code, person_data(person))
            }
            Self::ForgetPerson(code) => write!(f, "forget person {code}"),
            Self::Store(order) => f.write_str(order.name()),
            Self::UploadBegin(rows, direct_m2k_w) => {
                write!(f, "upload begin object {rows} {:.9}", MM2_PER_M2 * direct_m2k_w)
            }
            Self::UploadRow(index, row) => {
                let gain_mm2k_j = MM2_PER_M2 * row.gain_m2k_j;
                write!(f, "upload row {index} {:.9} {gain_mm2k_j:.9}", row.rate_1_s)
            }
            Self::UploadCommit(checksum) => write!(f, "upload commit {checksum:08x}"),
        }
    }
}

impl Command for PlainCommand {
    type Reply = ();

    fn read_reply(&self, reply: &Fields<'_>) -> Option<()> {
        reply.text().is_empty().then_some(())
    }
}

/// The commands that upload an object: begin, one row for each relaxation, and commit.
pub fn upload(object: &Impedance<'_>) -> Vec<PlainCommand> {
    let relaxations = object.relaxations;
    let mut commands = vec![PlainCommand::UploadBegin(relaxations.len(), object.direct_m2k_w)];
    let rows = relaxations.iter().enumerate();
    commands.extend(rows.map(|(index, row)| PlainCommand::UploadRow(index, *row)));
    with_commit(commands)
}

/// The commands that upload a course of points, s and °C (or K above the skin): begin, one row for each point, and commit.
pub fn upload_course(temperatures: TemperatureKind, points: &[(f64, f64)]) -> Vec<PlainCommand> {
    let mut commands = vec![PlainCommand::UploadCourse(points.len(), temperatures)];
    let rows = points.iter().enumerate();
    commands.extend(
        rows.map(|(index, (t_s, celsius))| PlainCommand::UploadPoint(index, *t_s, *celsius)),
    );
    with_commit(commands)
}

/// The word of a value in a table of the protocol.
fn word_in<T: PartialEq>(table: &[(&'static str, T)], value: &T) -> &'static str {
    let found = table.iter().find(|(_, known)| known == value);
    found.map_or("", |(word, _)| *word)
}

fn write_order(f: &mut fmt::Formatter<'_>, order: &PlayOrder) -> fmt::Result {
    let start = order.start.name();
    let end = word_in(&CourseEnd::PROTOCOL_WORDS, &order.end);
    write!(f, "{start} {} {end}", order.play_count)
}

/// The lines of an upload with their commit.
fn with_commit(mut commands: Vec<PlainCommand>) -> Vec<PlainCommand> {
    let sent: String = commands.iter().map(|command| format!("{command}\n")).collect();
    commands.push(PlainCommand::UploadCommit(CRC_32.checksum(sent.as_bytes())));
    commands
}

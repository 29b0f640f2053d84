//! Commands and queries of the host to a station, and what a station answers.
//!
//! These are values: `thermal-protocol` reads commands from lines of text, and writes answers as lines.

use core::fmt;
use thermal_settings::vocabulary;

use contact_model::contact_law::ContactLaw;
use contact_model::fixed_point::{
    Body, Celsius, ContactPair, ContactPairError, FingerBody, OwnContactLaw, to_fixed,
};
use contact_model::material::{Material, SKIN, Surface};
use fixed::types::U16F16;
use thermal_learner::Flux;
use thermal_settings::Person;

use crate::control::{ControlParameters, Law};
use crate::events::{EventKinds, TriggerPulse};
use crate::identification::{AbortReason, NormalEquationRow};
use crate::learning::{FingerKnowledge, FluxParameters, NoContactCodeSum, PersonState};
use crate::reference::ContactModel;
use crate::safety::{Fault, PredictedDose, SelfTestReport, Setpoint, TripCause};
use crate::sense::{CalibrationTables, Samples, ThermistorAverage};
use crate::stimulus::{CourseChunk, PlayOrder};
use crate::{StateName, TICK_S, TelemetryFields};

/// Upper limit of [`ChosenMaterial::impedance_ratio`]. An object at this limit takes hardly any heat.
const EFFUSIVITY_RATIO_MAX: f64 = 200.0;

/// A material that the host has chosen, with all that a contact with it needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenMaterial {
    /// Name of the material, or `custom` if the host has given its properties; [`Command::Status`] reports this name.
    pub name: &'static str,
    /// Conductivity, density, specific heat and surface finish.
    pub properties: Material,
    /// Contact constants of the finger's skin, this material and the display's surface, from which set-points and the
    /// finger's heat flow are computed.
    pub pair: ContactPair,
    /// Impedance of a half-space of this material divided by that of the thesis's skin, which is the effusivity of the skin
    /// divided by that of the material; limited to 200.
    pub impedance_ratio: U16F16,
}

impl ChosenMaterial {
    /// Computes the constants of a contact with this material, on a display with this surface. Uses `f64`, which is slow
    /// on the microcontroller.
    ///
    /// # Errors
    /// The contact model cannot represent a property.
    pub fn new(
        name: &'static str,
        properties: &Material,
        display: &Surface,
    ) -> Result<Self, ContactPairError> {
        let ratio = SKIN.effusivity() / properties.effusivity();
        Ok(Self {
            name,
            properties: *properties,
            pair: ContactPair::new(&SKIN, properties, display, TICK_S)?,
            impedance_ratio: to_fixed(ratio.min(EFFUSIVITY_RATIO_MAX)),
        })
    }
}

/// How an object conducts heat behind its touched face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObjectBody {
    /// As a half-space of its material.
    HalfSpace,
    /// As a slab of its material, by these relaxations.
    Slab(Body),
    /// By relaxations that the host has uploaded.
    Upload(Body),
}

impl ObjectBody {
    /// Its word in the protocol.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::HalfSpace => "half-space",
            Self::Slab(_) => "slab",
            Self::Upload(_) => "upload",
        }
    }

    /// Its relaxations, unless it is a half-space.
    pub const fn relaxations(&self) -> Option<&Body> {
        match self {
            Self::HalfSpace => None,
            Self::Slab(body) | Self::Upload(body) => Some(body),
        }
    }
}

vocabulary! {
    /// The finger that the device assumes for the unknown one that touches.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum AssumedFinger: "finger" {
        /// The mean layered finger, in air before contact: the device's default.
        #[default]
        Mean = "mean",
        /// The mean layered finger, on an insulating pad before contact.
        MeanOnPad = "mean-on-pad",
        /// The thesis's half-space of skin.
        Thesis = "thesis",
    }
}

impl AssumedFinger {
    /// Its tissue, and the film of air or pad before contact.
    pub const fn body(self) -> &'static FingerBody {
        match self {
            Self::Thesis => &FingerBody::THESIS,
            Self::Mean => &FingerBody::MEAN,
            Self::MeanOnPad => &FingerBody::MEAN_ON_PAD,
        }
    }

    /// Whether its tissue has layers. All layered fingers have the same tissue.
    pub const fn is_layered(self) -> bool {
        match self {
            Self::Thesis => false,
            Self::Mean | Self::MeanOnPad => true,
        }
    }
}

/// A contact law that the host has chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenContactLaw {
    /// The law as the host sent it.
    pub sent: ContactLaw,
    /// The same for the control path; `None` for Eq. 6-8.
    pub own: Option<OwnContactLaw>,
}

impl ChosenContactLaw {
    /// Eq. 6-8.
    pub const NOMINAL: Self = Self { sent: ContactLaw::NOMINAL, own: None };

    /// Computes the constants of a law. Uses `f64`, which is slow on the microcontroller.
    pub fn new(sent: ContactLaw) -> Self {
        Self { sent, own: OwnContactLaw::new(&sent, TICK_S) }
    }
}

/// A command or query of the host to one finger's station. All values are within their ranges; whether the station's
/// state permits the command is decided only when the station executes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command<'a> {
    /// Report the state, the chosen material, body, object temperature and contact model, and the set-point of the last
    /// tick, by [`Reply::Status`]. Never refused.
    Status,
    /// Send a line of telemetry every `interval_ms` from now on. While telemetry is on and the display follows a
    /// set-point (in armed, preset and contact), 2 s without a line from the host trip the station by
    /// [`Fault::HostSilent`].
    Stream {
        /// Time from one line of telemetry to the next, ms, up to 60000; 0 switches telemetry off.
        interval_ms: u32,
        /// The fields of each line.
        fields: TelemetryFields,
    },
    /// Choose the material of the object that `start` presents, as a half-space. If an object is presented already, the
    /// new one replaces it at once; if a finger touches, a new contact begins.
    Material(ChosenMaterial),
    /// Report the properties of the chosen material. Never refused.
    MaterialProperties,
    /// Choose how the object conducts heat behind its touched face. If a finger touches, a new contact begins.
    Body(ObjectBody),
    /// Choose the finger that is assumed for the one that touches. If that changes it, a finger that touches begins a new
    /// contact. `None` changes nothing: the answer is the assumed finger.
    Finger(Option<AssumedFinger>),
    /// Choose the contact law of the finger; choosing another finger makes it the nominal one. A finger that touches begins a new
    /// contact, and with a heat-flux sensor the finger is learnt anew. Refused for the thesis's finger. `None` changes nothing:
    /// the answer is the law in use.
    ContactLaw(Option<ChosenContactLaw>),
    /// Choose the object's temperature before contact, °C; `None` takes the room's. If a finger touches, a new contact
    /// begins.
    Object(Option<Celsius>),
    /// Choose the contact model that gives the set-point while an object is presented. If that changes the model while
    /// a finger touches, a new contact begins.
    Mode(ContactModel),
    /// Choose the control law that computes the current. A law `pi` or `pi-10hz` that was not in use starts from the
    /// present current; the law `model` continues from the plate's observer, which runs with every law. `None` changes
    /// nothing: the answer is the law in use.
    Law(Option<Law>),
    /// Drive the display to skin temperature, with no object presented. From off the self-test runs first; from ready,
    /// armed, preset and contact the display moves at once. A `hold` or an identification of the tile ends, and the
    /// result of an identification is discarded. No effect in the self-test; refused while the station is tripped.
    Arm,
    /// Move the set-point from the display's present reading, or from that of the present hold or course, to a
    /// temperature, and stay there. Refused in off, self-test, ready and tripped.
    Hold {
        /// Where the set-point stays.
        target: Setpoint,
        /// Rate, K/s, above zero.
        rate_k_s: Celsius,
    },
    /// Load a chunk of a course, which with its last chunk replaces the one that was loaded before, but not one that plays.
    /// `None` only asks whether loading is permitted, and is refused while the station is tripped; to be sent before the first
    /// chunk. The chunks are never refused.
    LoadCourse(Option<CourseChunk<'a>>),
    /// Play the course that was loaded last. Refused in off, self-test, ready and tripped, if no course is loaded, and if
    /// its temperatures above the present skin or its dose are too large.
    Play(PlayOrder),
    /// Report events from now on, or none. Never refused.
    ReportEvents(bool),
    /// Give a pulse at the trigger output at events of these kinds. Never refused.
    TriggerOutput(EventKinds),
    /// Give pulses of this length at the trigger output from the next event on; `None` asks for the present one. Never refused.
    TriggerPulse(Option<TriggerPulse>),
    /// Assume this temperature of the skin before contact, °C, for set-points, or that of the sensor for `None`. If a
    /// finger touches, a new contact begins. Limits, dose and detectors keep the sensor.
    AssumeSkin(Option<Celsius>),
    /// Present the chosen object: the display goes to the preset, the temperature at which a contact with the object
    /// begins, and waits for a finger. Refused if the station is not armed, or if no material is chosen.
    Start,
    /// Switch the bridge off: leads from the self-test to off, and from armed, preset and contact to ready. Never
    /// refused; no effect in off, ready and tripped, where the bridge is off already.
    Abort,
    /// Change from tripped to off, from where `arm` runs the self-test again. Refused while a fault is present, and if
    /// the station is not tripped. If the board has raised a second fault while the first one was latched, the second
    /// one then trips the station ([`Refused::StillFaulty`]).
    Clear,
    /// Report the cause of the present trip or, after `clear`, of the last one. Never refused.
    Cause,
    /// Report what the last self-test has measured. Never refused.
    SelfTest,
    /// Report the samples of the last tick. Never refused.
    Raw,
    /// Report the mean of one thermistor's samples over half a second, for a calibration. Index of the thermistor: 0
    /// first display, 1 second display, 2 sink, 3 skin, 4 room. Refused while an object is presented, in the self-test,
    /// and while too few samples have been added ([`Refused::TooEarly`]).
    Average(usize),
    /// Begin to identify the tile: current pulses move the armed display, and each tick adds the display's response to
    /// the normal equations, from which the tile's parameters are fitted afterwards. Refused if the station is not
    /// armed, while a finger touches, and if the sink's thermistor has no valid reading.
    Tune,
    /// Report one row, by its index from 0 to 8, of the normal equations of the last identification of the tile.
    /// Refused unless that identification is complete, and while the station is tripped.
    NormalEquation(usize),
    /// Use these corrections of converter and thermistors from the next tick on; an identification of the tile that is
    /// still running ends without a result. Refused while an object is presented, because the finger would feel the
    /// change, and in the self-test, which a step of the readings would disturb.
    Calibrate(CalibrationTables),
    /// Use this heat-flux sensor from the next tick on, or none, and learn anew with it. Refused while an object is presented,
    /// because the finger would feel the change.
    FluxSensor(Option<FluxParameters>),
    /// The display has another surface from now on: contact constants of skin, chosen material (or any, before a choice) and
    /// this surface. What was learnt of the finger is forgotten. Refused while an object is presented, because the finger would
    /// feel the change.
    DisplaySurface(ContactPair),
    /// Begin to learn the finger of this person, or of an unknown one for `None`. A finger that touches begins a new contact.
    /// Refused without a heat-flux sensor, for the thesis's finger, and a person with another contact law than the nominal one.
    ChoosePerson(Option<Person>),
    /// Report the chosen person, and what was learnt of the finger. Refused without a heat-flux sensor.
    Person,
    /// The same, to store what was learnt. Refused also with another contact law than the nominal one.
    LearntPerson,
    /// Report the flux, and what is known of the finger by it. Never refused.
    Flux,
    /// Report the mean code of the heat-flux sensor over half a second without flux. Refused while an object is presented, without
    /// a sensor, while a finger touches, while display and room differ by more than 0.3 K, with codes that cannot be right, and
    /// less than half a second after the last contact.
    FluxZero,
    /// Use these gains and this model of the tile from the next tick on; an identification of the tile ends. Refused
    /// while an object is presented, because the finger would feel the change.
    Retune(ControlParameters),
}

/// What a station answers to a command that it has executed. The answer to a command that it has not executed is
/// [`Refused`].
// With a tag of a byte the compiler moves the contents by bytes, at addresses that are not aligned: `self-test` then locks the
// control tick out for 5.5 us instead of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u32)]
pub enum Reply {
    /// The command was executed and has no result to report.
    Done,
    /// Answer to [`Command::Status`]: state, chosen object and set-point of the station.
    Status(Status),
    /// Answer to [`Command::Law`] with `None`: the control law in use.
    Law(Law),
    /// Answer to [`Command::MaterialProperties`]; `None` before a material is chosen.
    Material(Option<Material>),
    /// Answer to [`Command::Finger`] with `None`: the assumed finger.
    Finger(AssumedFinger),
    /// Answer to [`Command::ContactLaw`] with `None`: the law in use.
    ContactLaw(ContactLaw),
    /// Answer to [`Command::TriggerPulse`] with `None`.
    TriggerPulse(TriggerPulse),
    /// Answer to [`Command::Cause`]: cause of the present trip or, after `clear`, of the last one. `None` if the
    /// station has not tripped since the start of the program, and was not tripped when it started.
    Cause(Option<TripCause>),
    /// Answer to [`Command::SelfTest`]: what the last self-test has measured.
    SelfTest(SelfTestReport),
    /// Answer to [`Command::Raw`]: the samples of the last tick.
    Raw(Samples),
    /// Answer to [`Command::Average`]: mean of one thermistor's sums of 16 conversions over 512 ticks of 1 ms, in
    /// converter counts before any calibration, and whether the thermistor was steady.
    Average(ThermistorAverage),
    /// Answer to [`Command::Flux`]; `None` without a heat-flux sensor.
    Flux(Option<FluxState>),
    /// Answer to [`Command::Person`].
    Person(PersonState),
    /// Answer to [`Command::FluxZero`].
    FluxZero(NoContactCodeSum),
    /// Answer to [`Command::NormalEquation`]: one row of the normal equations of the tile's identification.
    NormalEquation(NormalEquationRow),
}

/// What a station knows by its heat-flux sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FluxState {
    /// Flux out of the finger in the last tick, W/m²; `None` if the sensor's code cannot be right.
    pub flux: Option<Flux>,
    /// Estimated temperature of the display's surface under the finger, °C, then; `None` without an estimate of the plate.
    pub surface: Option<Celsius>,
    /// What is known of the finger.
    pub knowledge: FingerKnowledge,
}

/// Why a station refuses a command. A refused command changes nothing, except for a `clear` that finds a second fault
/// ([`Self::StillFaulty`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// `start` was sent in the state off or ready, in which the bridge is off: `arm` must come first.
    NotArmed,
    /// The command was `start`, [`Command::Average`] or [`Command::Calibrate`], and the self-test is running: 0.8 s, or
    /// longer if a finger disturbs it.
    Testing,
    /// `start` was sent before the first command `material`, so there is no object to present.
    NoMaterial,
    /// The command with this name, `contact` or `person`, was sent, and the assumed finger is the thesis's.
    NeedsLayeredFinger(&'static str),
    /// A person was to be chosen or enrolled while this contact law is set. The factor on the contact resistance that is stored of
    /// a person is relative to the nominal law.
    OtherContactLaw(ContactLaw),
    /// `start` was sent while an object is already presented.
    AlreadyStarted,
    /// The command with this name, `hold` or `play`, was sent in a state that does not drive the display (in tripped the reply is
    /// [`Self::Tripped`]).
    NeedsDrivenDisplay(&'static str),
    /// `tune` was sent in a state that does not drive the display (in tripped the reply is [`Self::Tripped`]), while an object or
    /// a course is presented, or without a valid reading of the sink.
    TuneNeedsArmed,
    /// The command was [`Command::Average`], [`Command::Calibrate`], [`Command::Retune`], [`Command::FluxSensor`],
    /// [`Command::DisplaySurface`] or [`Command::FluxZero`], and an object or a course is presented:
    /// the finger would feel the change, or disturb the average.
    Presenting,
    /// The command with this name, `tune` or `flux zero`, was sent while a finger touches the display; the finger's heat would
    /// distort the result.
    Touched(&'static str),
    /// The command with this name, `flux zero` or `person`, was sent, and no heat-flux sensor is fitted.
    NoFluxSensor(&'static str),
    /// The command was [`Command::FluxZero`], and the sensor's code cannot be right.
    FluxSensorFault,
    /// The command was [`Command::FluxZero`], and display and room, °C, given here unless their reading is invalid, differ by more
    /// than 0.3 K, so that heat flows between display and air.
    DisplayNotAtRoom {
        /// Temperature of the display.
        display: Option<Celsius>,
        /// Temperature of the room.
        room: Option<Celsius>,
    },
    /// A row of the normal equations was requested, but no `tune` has been sent since the last `arm` or `hold`, or
    /// there is no row with this index.
    NotTuned,
    /// A row of the normal equations was requested while the identification of the tile is still running.
    Tuning,
    /// A row of the normal equations was requested, but the identification of the tile has ended early, for this
    /// reason, and has no result.
    TuneAborted(AbortReason),
    /// The zero of the heat-flux sensor was requested within half a second after a contact or the start of the sensor. Or the
    /// mean of a thermistor was requested before 512 ticks (0.5 s) of samples had been added since the start of the
    /// program or, if later, since the last accepted `start`. Ticks in which an object is presented are not added,
    /// because a finger may touch the display then.
    TooEarly,
    /// The station is tripped by this fault, and the command needs one that is not tripped: `clear` must come first.
    Tripped(Fault),
    /// `clear` was sent, but the station is still tripped, for one of two reasons. This fault is still present, and the
    /// fault that has tripped the station stays latched. Or the board had raised this fault while another one was
    /// latched; `clear` has cleared that other one, and this fault has tripped the station again.
    StillFaulty(Fault),
    /// `clear` was sent to a station that is not tripped.
    NothingToClear,
    /// `play` was sent before a course was loaded.
    NoCourse,
    /// `play` was sent, and the temperature of the loaded course, °C, given here, would be out of range above the present
    /// skin.
    CourseOutOfRange(Celsius),
    /// `hold` or `play` was sent to a tile that was never identified, and would bring its set-point to this temperature, °C, which
    /// is outside of its range of 20 to 38 °C.
    UntunedRange(Celsius),
    /// The same, and the set-point would move at this rate, K/s, which is more than the 1 K/s of such a tile.
    UntunedRate(Celsius),
    /// `play` was sent, and the loaded course would bring the thermal dose to this, which trips.
    CourseDose(PredictedDose),
}

/// State, chosen object and set-point of one finger's station: the answer to [`Command::Status`], which the host sends
/// as `state`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State of the station; in the state tripped with the fault that has tripped it.
    pub state: StateName,
    /// Name of the material that the host has chosen; `None` before the first command `material`.
    pub material: Option<&'static str>,
    /// Temperature of the object before contact, °C, as chosen by the host; `None` if the object takes the room's
    /// temperature.
    pub object: Option<Celsius>,
    /// Contact model that the host has chosen; it gives the set-point while an object is presented.
    pub mode: ContactModel,
    /// Set-point of the last tick, °C. `None` if that tick began in off, self-test, ready or tripped, or found a fault:
    /// no set-point is followed then.
    pub setpoint: Option<Celsius>,
    /// Whether the set-point of the last tick is not the one that was asked for, because that is outside of its range; or, on a
    /// tile that was never identified, moves too fast.
    pub limited: bool,
    /// Whether the tile was identified or set; if not, the set-point is limited to 20 to 38 °C and 1 K/s.
    pub is_tuned: bool,
    /// Word for the body of the object that the host has chosen: [`ObjectBody::name`].
    pub body: &'static str,
}

/// A reply, refusal or telemetry together with the finger that it comes from, so that the line to the host can name the
/// finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithSourceFinger<T> {
    /// Index of the finger, from 0. `None` if the content concerns the device as a whole. On a device with one finger
    /// also `None`, except in the answer to a line of the host that has named the finger.
    pub finger: Option<u8>,
    /// The reply, refusal or telemetry itself, without the finger.
    pub content: T,
}

impl<T> WithSourceFinger<T> {
    /// Content that belongs to the device as a whole, so that its line to the host names no finger.
    pub const fn from_whole_device(content: T) -> Self {
        Self { finger: None, content }
    }

    /// Converts the content by `function`, for example a refusal to the error that the host receives; the finger stays.
    pub fn map_content<U>(self, function: impl FnOnce(T) -> U) -> WithSourceFinger<U> {
        WithSourceFinger { finger: self.finger, content: function(self.content) }
    }
}

/// Writes the line to the host: the address of the finger, such as `@3 `, if there is a finger, and then the content.
impl<T: fmt::Display> fmt::Display for WithSourceFinger<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(finger) = self.finger {
            write!(f, "@{finger} ")?;
        }
        self.content.fmt(f)
    }
}

//! What a host may ask of a station, and what a station answers.
//!
//! These are values: `thermal-protocol` reads them from lines of text and writes the answers.

use core::fmt;

use contact_model::fixed_point::{Celsius, ContactPair};

use crate::StateName;
use crate::control::{ControlParameters, Law};
use crate::identification::{AbortReason, NormalEquationRow};
use crate::reference::Mode;
use crate::safety::{Fault, Setpoint, TripCause};
use crate::sense::{CalibrationTables, ThermistorAverage};

/// What a host may ask of one finger's station. The values are in their ranges; whether the station's state permits the
/// command is decided when it is executed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Report state, material, object temperature, mode and set-point, and whether the set-point was clamped; never
    /// refused.
    Status,
    /// Send a line of telemetry at this interval from now on. A host that then sends nothing for 2 s trips a station
    /// that follows a set-point.
    Stream {
        /// Time from one line of telemetry to the next, ms; 0 ends the stream.
        interval_ms: u32,
    },
    /// Choose the material of the object, which `start` presents. If an object is presented already, the new one
    /// replaces it at once, and a finger that touches begins a new contact.
    Material {
        /// Name of the material, or `custom` if the host has given its properties; `status` reports it.
        name: &'static str,
        /// Constants of the contact of a finger with this material and with the display, from which set-points are
        /// computed.
        pair: ContactPair,
    },
    /// Choose the object's temperature before contact, °C; `None` takes the room's. A finger that touches begins a new
    /// contact.
    Object(Option<Celsius>),
    /// Choose the model that gives the set-point during contact; a finger that touches begins a new contact if it
    /// differs.
    Mode(Mode),
    /// Choose the control law that gives the current, which starts from the present current; `None` only asks for the
    /// law in use.
    Law(Option<Law>),
    /// Drive the display to skin temperature: from off after the self-test, from ready, armed, preset and contact at
    /// once. Refused while the station is tripped.
    Arm,
    /// Drive an armed display to this temperature, by 1 K/s from the present reading.
    Hold(Setpoint),
    /// Present the chosen material on an armed display: it goes to the preset of the selected model and waits for a
    /// finger.
    Start,
    /// Switch the bridge off: a self-test ends in off, every other driven state in ready. Never refused; no effect if
    /// the bridge is off already.
    Abort,
    /// Leave the state tripped for off, if no fault is present any more.
    Clear,
    /// Report the cause of the present trip or, after `clear`, of the last one.
    Cause,
    /// Report the mean sample of the thermistor with this index over half a second, for a calibration: 0 display, 1
    /// second display, 2 sink, 3 skin, 4 room. Refused while an object is presented, and in the self-test.
    Average(usize),
    /// Identify the tile: drive an armed, untouched display by current pulses and add up the normal equations of its
    /// response.
    Tune,
    /// Report the row with this index, from 0, of the normal equations that a complete identification has added up.
    NormalEquation(usize),
    /// Use these corrections of the thermistors from the next tick on. Refused while an object is presented, and in the
    /// self-test.
    Calibrate(CalibrationTables),
    /// Use these gains and this model of the tile from the next tick on. Refused while an object is presented.
    Retune(ControlParameters),
}

/// What a station answers to a command that it has executed; [`Refused`] is the answer to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// The command was executed, and asks for nothing that would have to be reported.
    Done,
    /// What the station is doing, for [`Command::Status`].
    Status(Status),
    /// The control law in use, for [`Command::Law`] without a law.
    Law(Law),
    /// Cause of the present or the last trip, for [`Command::Cause`]; `None` if the station has never tripped.
    Cause(Option<TripCause>),
    /// Mean of a thermistor's samples over 512 ticks, for [`Command::Average`].
    Average(ThermistorAverage),
    /// One row of the identification's normal equations, for [`Command::NormalEquation`].
    NormalEquation(NormalEquationRow),
}

/// Why a station refuses a command. Nothing has changed then, except by a `clear` that finds a second fault
/// ([`Self::StillFaulty`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// `start` was sent in the state off or ready, in which the bridge is off: `arm` must come first.
    NotArmed,
    /// The command was `start`, or one of a calibration, and the self-test is running, which takes 0.7 s without a
    /// finger.
    Testing,
    /// `start` was sent before the first `material`, so there is no object to present.
    NoMaterial,
    /// `start` was sent while an object is presented already.
    AlreadyStarted,
    /// This command, `hold` or `tune`, was sent in another state than armed; `tune` also before the first reading of
    /// the sink.
    NeedsArmed(&'static str),
    /// The command was one of a calibration or an identification, and an object is presented, whose feeling it would
    /// change.
    Presenting,
    /// `tune` was sent with a finger on the display, whose heat would distort the result.
    Touched,
    /// The normal equations were asked for, but no `tune` has been sent since the last `arm` or `hold`, or they have no
    /// such row.
    NotTuned,
    /// The normal equations were asked for while the identification is still running.
    Tuning,
    /// The normal equations were asked for, but the identification has ended early, for this reason.
    TuneAborted(AbortReason),
    /// The mean of a thermistor was asked for before it covered 512 ticks (0.5 s) since power-up or since an object was
    /// last presented; ticks while an object is presented do not count, because a finger may touch the display then.
    TooEarly,
    /// The command needs a station that is not tripped, and this fault is latched: `clear` must come first.
    Tripped(Fault),
    /// `clear` was sent while this fault is present, or pending because the board has raised it after the latched one;
    /// then the station is now tripped by it.
    StillFaulty(Fault),
    /// `clear` was sent to a station that is not tripped.
    NothingToClear,
}

/// What one finger's station is doing and presenting, as `status` reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State of the station and, if it is tripped, the latched fault.
    pub state: StateName,
    /// Name of the chosen material; `None` before the first `material`.
    pub material: Option<&'static str>,
    /// Chosen temperature of the object before contact, °C; `None` if it is that of the room.
    pub object: Option<Celsius>,
    /// Chosen model, which gives the set-point while an object is presented.
    pub mode: Mode,
    /// Set-point of the last tick, °C; `None` if the bridge was off, and in the self-test.
    pub setpoint: Option<Celsius>,
    /// Whether the set-point of the last tick was clamped to 15 to 42 °C.
    pub limited: bool,
}

/// A reply, refusal or telemetry with the finger that it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Addressed<T> {
    /// Index of the finger, from 0; `None` if the content concerns the device as a whole, or if a device has only one
    /// finger and the host has named none.
    pub finger: Option<u8>,
    /// The reply, refusal or telemetry itself.
    pub content: T,
}

impl<T> Addressed<T> {
    /// Content that comes from the device as a whole, so its line names no finger.
    pub const fn from_whole_device(content: T) -> Self {
        Self {
            finger: None,
            content,
        }
    }

    /// Converts the content by `function`, for example a refusal to an error with its words; the finger stays.
    pub fn map_content<U>(self, function: impl FnOnce(T) -> U) -> Addressed<U> {
        Addressed {
            finger: self.finger,
            content: function(self.content),
        }
    }
}

/// Writes the content, after three bytes that name the finger, `@`, its index and a space, if there is one.
impl<T: fmt::Display> fmt::Display for Addressed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(finger) = self.finger {
            write!(f, "@{finger} ")?;
        }
        self.content.fmt(f)
    }
}

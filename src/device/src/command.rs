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

/// A command for one station, checked and ready to execute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Report state, material, object temperature, mode and set-point.
    Status,
    /// Send telemetry at this interval; 0 ends it.
    Stream {
        /// Time between two lines of telemetry, ms.
        interval_ms: u32,
    },
    /// Choose the material of the object; it is presented from the next `start` on, or at once if an object is
    /// presented.
    Material {
        /// Name of the material, or `custom` if its properties were given.
        name: &'static str,
        /// The material under a finger, beside the display.
        pair: ContactPair,
    },
    /// Temperature of the object before contact; `None` takes that of the room.
    Object(Option<Celsius>),
    /// Which model gives the set-point.
    Mode(Mode),
    /// Which control law finds the current; `None` asks.
    Law(Option<Law>),
    /// Drive the display to skin temperature, after a self-test if the bridge was off.
    Arm,
    /// Drive the display to a temperature.
    Hold(Setpoint),
    /// Present the chosen material: the display goes to the preset of Eq. 6-12 and waits for a finger.
    Start,
    /// Switch the bridge off, in any state.
    Abort,
    /// Take back a fault that is no longer present.
    Clear,
    /// Report why the station tripped, now or the last time.
    Cause,
    /// Report the mean of a thermistor's samples, by its index.
    Average(usize),
    /// Identify the tile: drive current pulses and record the display's response.
    Tune,
    /// Report a row of the identification's normal equations.
    NormalEquation(usize),
    /// Use another calibration of the thermistors.
    Calibrate(CalibrationTables),
    /// Use the control parameters of another tile.
    Retune(ControlParameters),
}

/// The reply of a station to a command that it has executed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// The command was executed, and there is nothing to report.
    Done,
    /// Answer to [`Command::Status`].
    Status(Status),
    /// Answer to [`Command::Law`] without a law.
    Law(Law),
    /// Answer to [`Command::Cause`].
    Cause(Option<TripCause>),
    /// Answer to [`Command::Average`].
    Average(ThermistorAverage),
    /// Answer to [`Command::NormalEquation`].
    NormalEquation(NormalEquationRow),
}

/// Why a station refuses a command; nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// `start` was sent before `arm`.
    NotArmed,
    /// The self-test is running, which takes 0.7 s.
    Testing,
    /// `start` was sent before `material`.
    NoMaterial,
    /// `start` while an object is presented.
    AlreadyStarted,
    /// The named command needs the state armed.
    NeedsArmed(&'static str),
    /// An object is presented, and the command would change what the finger feels.
    Presenting,
    /// `tune` with a finger on the display.
    Touched,
    /// The tile was not identified since `arm`.
    NotTuned,
    /// The identification of the tile is still running.
    Tuning,
    /// The identification of the tile ended early, for this reason.
    TuneAborted(AbortReason),
    /// The mean of a thermistor is not complete.
    TooEarly,
    /// This fault is latched, and must be cleared first.
    Tripped(Fault),
    /// `clear` while the fault is present.
    StillFaulty(Fault),
    /// `clear` was sent while no fault is latched.
    NothingToClear,
}

/// What a station is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State and, if tripped, the fault.
    pub state: StateName,
    /// Name of the chosen material; `None` before the first choice.
    pub material: Option<&'static str>,
    /// Object temperature; `None` takes that of the room.
    pub object: Option<Celsius>,
    /// Model that gives the set-point.
    pub mode: Mode,
    /// Set-point of the last tick, if the bridge was driven.
    pub setpoint: Option<Celsius>,
    /// The set-point was limited to the safe range.
    pub limited: bool,
}

/// A command, reply or telemetry with the finger that it is for or from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Addressed<T> {
    /// Index of the finger, from 0; `None` addresses the device as a whole.
    pub finger: Option<u8>,
    /// The command, reply or telemetry.
    pub content: T,
}

impl<T> Addressed<T> {
    /// Addresses the device as a whole.
    pub const fn device(content: T) -> Self {
        Self {
            finger: None,
            content,
        }
    }

    /// Applies a function to the content and keeps the address.
    pub fn map<U>(self, function: impl FnOnce(T) -> U) -> Addressed<U> {
        Addressed {
            finger: self.finger,
            content: function(self.content),
        }
    }
}

/// Writes `@`, the index of the finger and a space, three bytes, before the content if a finger is addressed.
impl<T: fmt::Display> fmt::Display for Addressed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(finger) = self.finger {
            write!(f, "@{finger} ")?;
        }
        self.content.fmt(f)
    }
}

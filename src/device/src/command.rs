//! What a host may ask of a station, and what a station answers.
//!
//! These are values: `thermal-protocol` reads them from lines of text and writes the answers.

use core::fmt;

use contact_model::fixed_point::{Celsius, ContactPair};

use crate::control::{Law, Tuned};
use crate::identification::{Aborted, Row};
use crate::reference::Mode;
use crate::safety::{Cause, Fault, Setpoint, State};
use crate::sense::{Average, Calibrated};

/// A command for one station, checked and ready to execute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Report state, material, object temperature, mode and set-point.
    Status,
    /// Send telemetry at this interval; 0 ends it.
    Stream {
        /// Interval, ms.
        interval_ms: u32,
    },
    /// Present this material.
    Material {
        /// Name, or `custom`.
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
    /// Present the object.
    Start,
    /// Switch the bridge off.
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
    Experiment(usize),
    /// Use another calibration of the thermistors.
    Calibrate(Calibrated),
    /// Control another tile.
    Retune(Tuned),
}

/// What a station answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// The command was executed.
    Done,
    /// Answer to [`Command::Status`].
    Status(Status),
    /// Answer to [`Command::Law`] without a law.
    Law(Law),
    /// Answer to [`Command::Cause`].
    Cause(Option<Cause>),
    /// Answer to [`Command::Average`].
    Average(Average),
    /// Answer to [`Command::Experiment`].
    Row(Row),
}

/// Why a station refuses a command; nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// `start` before `arm`.
    NotArmed,
    /// The self-test is running.
    Testing,
    /// `start` before `material`.
    NoMaterial,
    /// `start` while an object is presented.
    AlreadyStarted,
    /// The named command needs the state armed.
    NeedsArmed(&'static str),
    /// An object is presented.
    Presenting,
    /// `tune` with a finger on the display.
    Touched,
    /// The tile was not identified since `arm`.
    NotTuned,
    /// The identification is running.
    Tuning,
    /// The identification ended early.
    TuneAborted(Aborted),
    /// The mean of a thermistor is not complete.
    TooEarly,
    /// A fault is latched.
    Tripped(Fault),
    /// `clear` while the fault is present.
    StillFaulty(Fault),
    /// `clear` without a fault.
    NothingToClear,
}

/// What a station is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State and, if tripped, the fault.
    pub state: State,
    /// Chosen material.
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

/// Something said to or by one finger, or to or by the device as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Addressed<T> {
    /// Number of the finger, from 0; `None` for the device.
    pub finger: Option<u8>,
    /// What is said.
    pub said: T,
}

impl<T> Addressed<T> {
    /// Said to or by the device as a whole.
    pub const fn device(said: T) -> Self {
        Self { finger: None, said }
    }

    /// Applies a function to what is said.
    pub fn map<U>(self, function: impl FnOnce(T) -> U) -> Addressed<U> {
        Addressed {
            finger: self.finger,
            said: function(self.said),
        }
    }
}

/// Writes `@` and the finger's number before what is said: three bytes more.
impl<T: fmt::Display> fmt::Display for Addressed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(finger) = self.finger {
            write!(f, "@{finger} ")?;
        }
        self.said.fmt(f)
    }
}

//! The states of a station and the transitions between them.

use crate::StateName;
use crate::hold::TemperatureHold;
use crate::identification::Identification;
use crate::safety::{Fault, SelfTest};

/// State of one finger's station, with the data that the station has in this state only.
#[derive(Clone, Debug)]
pub enum State {
    /// The bridge is off after power-up, after `clear`, or after `abort` of the self-test; `arm` starts the self-test.
    Off,
    /// The self-test runs: the comparator is tested with the bridge off, then 1 A cools and warms; leads to armed if it
    /// passes.
    SelfTest(SelfTest),
    /// The bridge is off after `abort`. The self-test has passed before, so `arm` leads to armed at once.
    Ready,
    /// The bridge drives the display for this task, and no object is presented.
    Armed(ArmedTask),
    /// An object is presented: the display waits at its preset temperature, and no finger touches it.
    Preset,
    /// An object is presented, and a finger touches the display, whose temperature follows the contact model.
    Contact,
    /// The bridge is off because of this fault, the first since the last `clear`, until the host sends `clear` and the
    /// fault is gone.
    Tripped(Fault),
}

/// What the display does while the station is armed, with the data of that task.
#[derive(Clone, Debug)]
pub enum ArmedTask {
    /// Stay at the temperature that the finger's skin had before contact, whether a finger touches or not.
    Neutral,
    /// Move to a temperature that the host has chosen, by 1 K/s, and stay there.
    Hold(TemperatureHold),
    /// Identify the tile by current pulses about an operating point, and stay there until the result is used.
    Identify(Identification),
}

/// What may move a station from one state to another; [`State::state_after`] says where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The host has sent `arm`: from off to the self-test, from ready, preset and contact to armed.
    Arm,
    /// The self-test has passed, and leads to armed.
    Pass,
    /// The host has sent `start` in the state armed, and a material is chosen: leads to preset.
    Start,
    /// A finger touches the display, reported in every tick of a contact: leads from preset to contact.
    Land,
    /// No finger touches the display, reported in every such tick: leads from contact to preset.
    Lift,
    /// The host has sent `abort`, which switches the bridge off: from the self-test to off, else to ready.
    Abort,
    /// The host has sent `clear`, and no fault is present any more: leads from tripped to off.
    Clear,
    /// This fault is detected in a tick, or raised by the board: leads to tripped from every other state.
    Trip(Fault),
}

impl State {
    /// Name of the state as status and telemetry report it; with the fault if it is tripped.
    #[must_use]
    pub const fn name(&self) -> StateName {
        match self {
            Self::Off => StateName::Off,
            Self::SelfTest(_) => StateName::SelfTest,
            Self::Ready => StateName::Ready,
            Self::Armed(_) => StateName::Armed,
            Self::Preset => StateName::Preset,
            Self::Contact => StateName::Contact,
            Self::Tripped(fault) => StateName::Tripped(*fault),
        }
    }

    /// The transition table: the state that `event` leads to from this one, at the beginning of its data; `None` if the
    /// event changes nothing. docs/safety.md has the same table, and a unit test compares both.
    #[must_use]
    pub fn state_after(&self, event: Event) -> Option<Self> {
        Some(match (self, event) {
            (Self::Tripped(_), Event::Clear) => Self::Off,
            // The first fault stays latched.
            (Self::Tripped(_), _) => return None,
            (_, Event::Trip(fault)) => Self::Tripped(fault),
            (Self::Off, Event::Arm) => Self::SelfTest(SelfTest::default()),
            (Self::SelfTest(_), Event::Pass) => Self::Armed(ArmedTask::Neutral),
            (Self::SelfTest(_), Event::Abort) => Self::Off,
            (Self::Ready | Self::Armed(_) | Self::Preset | Self::Contact, Event::Arm) => {
                Self::Armed(ArmedTask::Neutral)
            }
            (Self::Armed(_), Event::Start) | (Self::Contact, Event::Lift) => Self::Preset,
            (Self::Preset, Event::Land) => Self::Contact,
            (Self::Armed(_) | Self::Preset | Self::Contact, Event::Abort) => Self::Ready,
            _ => return None,
        })
    }

    /// Whether an object is presented, with or without a finger: in preset and contact. Calibration and new parameters
    /// are refused then, because the finger would feel them.
    #[must_use]
    pub const fn is_presenting(&self) -> bool {
        matches!(self, Self::Preset | Self::Contact)
    }

    /// The fault by which the station is tripped; `None` in every other state.
    #[must_use]
    pub const fn latched_fault(&self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(*fault),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

//! The states of a station and the transitions between them.

use crate::StateName;
use crate::hold::Hold;
use crate::identification::Identification;
use crate::safety::{Fault, SelfTest};

/// A state with the data that only it has.
#[derive(Clone, Debug)]
pub enum State {
    /// The bridge is off, and nothing is tested.
    Off,
    /// The comparator is tested, then small currents are driven.
    SelfTest(SelfTest),
    /// The bridge is off; the self-test has passed.
    Ready,
    /// The display is driven, and no object is presented.
    Armed(Task),
    /// An object is presented, and no finger touches it.
    Preset,
    /// An object is presented to the finger that touches it.
    Contact,
    /// The bridge is off until the host clears the fault.
    Tripped(Fault),
}

/// What an armed display does.
#[derive(Clone, Debug)]
pub enum Task {
    /// Stay at skin temperature, touched or not.
    Neutral,
    /// Stay at a temperature that the host has chosen.
    Hold(Hold),
    /// Drive current pulses that identify the tile.
    Identify(Identification),
}

/// What moves a station from one state to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The host sends `arm`.
    Arm,
    /// The self-test has passed.
    Pass,
    /// The host sends `start`.
    Start,
    /// A finger lands on the display.
    Land,
    /// The finger lifts from the display.
    Lift,
    /// The host sends `abort`.
    Abort,
    /// The host sends `clear`, and no fault is present.
    Clear,
    /// A fault is detected, or raised by the board.
    Trip(Fault),
}

impl State {
    /// The state without its data, as it is reported to the host.
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

    /// The transition table: the state that an event leads to; `None` if the event changes nothing.
    #[must_use]
    pub fn after(&self, event: Event) -> Option<Self> {
        Some(match (self, event) {
            (Self::Tripped(_), Event::Clear) => Self::Off,
            // The first fault stays latched.
            (Self::Tripped(_), _) => return None,
            (_, Event::Trip(fault)) => Self::Tripped(fault),
            (Self::Off, Event::Arm) => Self::SelfTest(SelfTest::default()),
            (Self::SelfTest(_), Event::Pass) => Self::Armed(Task::Neutral),
            (Self::SelfTest(_), Event::Abort) => Self::Off,
            (Self::Ready | Self::Armed(_) | Self::Preset | Self::Contact, Event::Arm) => {
                Self::Armed(Task::Neutral)
            }
            (Self::Armed(_), Event::Start) | (Self::Contact, Event::Lift) => Self::Preset,
            (Self::Preset, Event::Land) => Self::Contact,
            (Self::Armed(_) | Self::Preset | Self::Contact, Event::Abort) => Self::Ready,
            _ => return None,
        })
    }

    /// Whether an object is presented, or would be to a finger that lands.
    #[must_use]
    pub const fn presents(&self) -> bool {
        matches!(self, Self::Preset | Self::Contact)
    }

    /// The fault that is latched.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(*fault),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

//! Names of a station's states, as they are reported.

use crate::safety::Fault;

/// The state of one finger's station as status and telemetry report it, without what only the station itself needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateName {
    /// The bridge is off after power-up, after `clear`, or after `abort` of the self-test; `arm` starts the self-test.
    Off,
    /// The self-test runs, 0.7 s without a finger: the comparator is tested with the bridge off, then 1 A cools and
    /// warms.
    SelfTest,
    /// The bridge is off after `abort`; the self-test has passed before, so `arm` drives at once.
    Ready,
    /// The display is kept at skin temperature or held at a temperature, or the tile is identified; no object is
    /// presented.
    Armed,
    /// An object is presented, and the display waits at its preset temperature for a finger.
    Preset,
    /// An object is presented, and a finger touches the display.
    Contact,
    /// The bridge is off because of this fault, until the host sends `clear` and the fault is gone.
    Tripped(Fault),
}

impl StateName {
    /// The word by which lines to the host name the state, such as `self-test`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::SelfTest => "self-test",
            Self::Ready => "ready",
            Self::Armed => "armed",
            Self::Preset => "preset",
            Self::Contact => "contact",
            Self::Tripped(_) => "tripped",
        }
    }

    /// The fault that has tripped the station; `None` in every state other than tripped.
    #[must_use]
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(fault),
            _ => None,
        }
    }
}

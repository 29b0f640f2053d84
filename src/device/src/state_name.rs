//! Names of a station's states, as they are reported.

use crate::safety::Fault;

/// The state of a station, without the data that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateName {
    /// The bridge is off, and nothing is tested.
    Off,
    /// The comparator is tested, then small currents are driven.
    SelfTest,
    /// The bridge is off; the self-test has passed.
    Ready,
    /// The display is driven, and no object is presented.
    Armed,
    /// An object is presented, and no finger touches it.
    Preset,
    /// An object is presented to the finger that touches it.
    Contact,
    /// The bridge is off until the host clears the fault.
    Tripped(Fault),
}

impl StateName {
    /// The state's word in the protocol.
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

    /// The fault that is latched, if the station has tripped.
    #[must_use]
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(fault),
            _ => None,
        }
    }
}

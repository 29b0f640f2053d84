//! What the device is doing.

use super::Fault;

/// The states of [the guard](super).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Bridge off, nothing is tested.
    Off,
    /// The comparator is tested, then a little current is driven.
    SelfTest,
    /// Bridge off, everything has worked.
    Ready,
    /// Display at skin temperature.
    Armed,
    /// An object is presented, no finger on it.
    Preset,
    /// An object is presented to the finger on it.
    Contact,
    /// Bridge off, until the host clears the fault.
    Tripped(Fault),
}

impl State {
    /// The word for it in the protocol.
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

    /// Why it is off, if tripped.
    #[must_use]
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(fault),
            _ => None,
        }
    }

    /// An object is presented, or would be to a finger that lands.
    #[must_use]
    pub const fn presents(self) -> bool {
        matches!(self, Self::Preset | Self::Contact)
    }
}

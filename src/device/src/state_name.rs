//! The states of a station as status and telemetry report them.

use crate::safety::Fault;

/// State of one finger's station as status and telemetry report it: without the internal data of the state, except for
/// the fault that has tripped the station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateName {
    /// The bridge is off: after a start of the program without a trip, after `clear`, or after `abort` of the
    /// self-test. `arm` leads to the self-test.
    Off,
    /// The self-test runs, for 0.8 s if no finger disturbs it: the comparator is tested with the bridge off, then 1 A
    /// cools and 1 A warms the display.
    SelfTest,
    /// The bridge is off after `abort` in armed, preset, contact or stimulus. The self-test was passed before, so `arm`
    /// leads to armed at once.
    Ready,
    /// No object is presented, and the bridge drives the display: to stay at skin temperature, or to identify
    /// the tile.
    Armed,
    /// An object is presented and no finger touches the display, which waits at the preset: the temperature at which a
    /// contact with the object begins.
    Preset,
    /// An object is presented and a finger touches the display, whose temperature follows the contact model.
    Contact,
    /// The display follows a temperature that the host prescribes: it holds one, or plays a course, or waits to begin one.
    Stimulus,
    /// The bridge is off because of this fault, the first since the last `clear`. The bridge stays off until the host
    /// sends `clear` when no fault is present any more.
    Tripped(Fault),
}

impl StateName {
    /// All states but tripped.
    pub const WITHOUT_FAULT: [Self; 7] = [
        Self::Off,
        Self::SelfTest,
        Self::Ready,
        Self::Armed,
        Self::Preset,
        Self::Contact,
        Self::Stimulus,
    ];

    /// The state's word in lines to the host, such as `self-test`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::SelfTest => "self-test",
            Self::Ready => "ready",
            Self::Armed => "armed",
            Self::Preset => "preset",
            Self::Contact => "contact",
            Self::Stimulus => "stimulus",
            Self::Tripped(_) => "tripped",
        }
    }

    /// Whether the bridge is driven in this state.
    pub const fn is_driven(self) -> bool {
        match self {
            Self::SelfTest | Self::Armed | Self::Preset | Self::Contact | Self::Stimulus => true,
            Self::Off | Self::Ready | Self::Tripped(_) => false,
        }
    }

    /// The fault that has tripped the station; `None` in every state other than tripped.
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(fault),
            _ => None,
        }
    }
}

//! The states of a station and the transitions between them.

use crate::StateName;
use crate::identification::Identification;
use crate::safety::{Fault, SelfTest};
use crate::stimulus::Stimulus;

/// State of one finger's station, with the data that exist only in that state.
// Tags of words, also in the contents: after a tag of a byte the compiler moves the contents by bytes.
#[derive(Clone, Debug)]
#[repr(u32)]
pub enum State {
    /// The bridge is off: after a start of the program without a trip, after `clear`, or after `abort` of the
    /// self-test. `arm` leads to the self-test.
    Off,
    /// The self-test runs: the comparator is tested with the bridge off, then 1 A cools and 1 A warms the display.
    /// Leads to armed if all checks pass, else to tripped.
    SelfTest(SelfTest),
    /// The bridge is off after `abort` in armed, preset, contact or stimulus. The self-test was passed before, so `arm`
    /// leads to armed at once.
    Ready,
    /// The bridge drives the display, and no object is presented. The [`ArmedTask`] says what the display does: stay at
    /// skin temperature, or be identified.
    Armed(ArmedTask),
    /// An object is presented and no finger touches the display, which waits at the preset: the temperature at which a
    /// contact with the object begins.
    Preset,
    /// An object is presented and a finger touches the display, whose temperature follows the contact model.
    Contact,
    /// The display follows temperatures that the host prescribes, with or without a finger on it; no object is presented.
    Stimulus(Stimulus),
    /// The bridge is off because of this fault, the first since the last `clear`. The bridge stays off until the host
    /// sends `clear` when no fault is present any more.
    Tripped(Fault),
}

/// What the display does while the station is armed, with the data that each task needs.
#[derive(Clone, Debug)]
#[repr(u32)]
pub enum ArmedTask {
    /// Stay at the temperature of the finger's skin, so that the finger feels no object. That temperature is the
    /// filtered reading of the skin's thermistor, kept constant from landing until 2 s after lifting, and for 2 s after
    /// the estimates have started or restarted.
    Neutral,
    /// Identify the tile: move to an operating point near the sink's temperature and apply current pulses there. Then
    /// stay at the operating point until a command, such as `arm`, or a fault ends this task. An identification that
    /// ends early changes the task to neutral.
    Identify(Identification),
}

/// What changes a station's state: a command of the host (except those that only change the task within armed), a finger
/// that lands or lifts, the passing of the self-test, or a fault.
/// [`State::state_after`] is the table of the transitions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// The host has sent `arm`: leads from off to the self-test, and from ready, armed, preset, contact and stimulus to
    /// armed, at skin temperature.
    Arm,
    /// The self-test has passed: leads from the self-test to armed, at skin temperature.
    Pass,
    /// The host has sent `start` in the state armed or stimulus, and a material is chosen: leads to preset.
    Start,
    /// The host has sent `hold`, `play` or `pulse`, which then says what the display does: leads from armed, preset,
    /// contact and stimulus to stimulus.
    Stimulate(&'a Stimulus),
    /// A course has ended after which the display shall be neutral: leads from stimulus to armed.
    EndNeutral,
    /// A finger touches the display; reported in every fault-free tick of a contact. Leads from preset to contact.
    Land,
    /// No finger touches the display; reported in every fault-free tick without contact. Leads from contact to preset.
    Lift,
    /// The host has sent `abort`, which switches the bridge off: leads from the self-test to off, and from armed,
    /// preset, contact and stimulus to ready. No effect in off, ready and tripped.
    Abort,
    /// The host has sent `clear`, and no fault is present any more: leads from tripped to off.
    Clear,
    /// A tick has detected this fault, or the board has raised it: leads to tripped from every other state. No effect
    /// in tripped, so that the first fault stays.
    Trip(Fault),
}

impl State {
    /// The state without its internal data, as status and telemetry report it; with the fault if the station is
    /// tripped.
    pub const fn state_name(&self) -> StateName {
        match self {
            Self::Off => StateName::Off,
            Self::SelfTest(_) => StateName::SelfTest,
            Self::Ready => StateName::Ready,
            Self::Armed(_) => StateName::Armed,
            Self::Preset => StateName::Preset,
            Self::Contact => StateName::Contact,
            Self::Stimulus(_) => StateName::Stimulus,
            Self::Tripped(fault) => StateName::Tripped(*fault),
        }
    }

    /// The transition table: the state to which `event` leads from this state, with the initial data of the new state;
    /// `None` if the event has no effect here. docs/safety.md shows the same table, and a unit test compares the two.
    #[inline(always)]
    pub fn state_after(&self, event: Event<'_>) -> Option<Self> {
        Some(match (self, event) {
            (Self::Tripped(_), Event::Clear) => Self::Off,
            // The first fault stays latched.
            (Self::Tripped(_), _) => return None,
            (_, Event::Trip(fault)) => Self::Tripped(fault),
            (Self::Off, Event::Arm) => Self::SelfTest(SelfTest::default()),
            (Self::SelfTest(_), Event::Pass) => Self::Armed(ArmedTask::Neutral),
            (Self::SelfTest(_), Event::Abort) => Self::Off,
            (
                Self::Ready | Self::Armed(_) | Self::Preset | Self::Contact | Self::Stimulus(_),
                Event::Arm,
            )
            | (Self::Stimulus(_), Event::EndNeutral) => Self::Armed(ArmedTask::Neutral),
            (Self::Armed(_) | Self::Stimulus(_), Event::Start) | (Self::Contact, Event::Lift) => {
                Self::Preset
            }
            (Self::Preset, Event::Land) => Self::Contact,
            (
                Self::Armed(_) | Self::Preset | Self::Contact | Self::Stimulus(_),
                Event::Stimulate(stimulus),
            ) => Self::Stimulus(*stimulus),
            (Self::Armed(_) | Self::Preset | Self::Contact | Self::Stimulus(_), Event::Abort) => {
                Self::Ready
            }
            _ => return None,
        })
    }

    /// Whether an object is presented, with or without a finger on the display: true in preset and contact.
    /// Calibrations and new control parameters are refused in these states, because the finger would feel the change.
    pub const fn is_presenting_object(&self) -> bool {
        matches!(self, Self::Preset | Self::Contact)
    }

    /// Whether a course plays or waits to begin. What would disturb it is refused, as while an object is presented.
    pub const fn is_presenting_course(&self) -> bool {
        matches!(self, Self::Stimulus(Stimulus::Wait(..) | Stimulus::Play(_)))
    }

    /// The fault that has tripped the station; `None` in every state other than tripped.
    pub const fn latched_fault(&self) -> Option<Fault> {
        match self {
            Self::Tripped(fault) => Some(*fault),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

//! The log of a session: lines of JSON, each with its time.

use serde::{Deserialize, Serialize};
use thermal_client::client::ReceivedEvent;

use crate::Update;
use crate::record::TrialRecord;

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// Time by the session's clock, s.
    pub t_s: f64,
    /// What happened.
    #[serde(flatten)]
    pub entry: Entry,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Entry {
    /// Participant and operator were told something.
    Update(Update),
    /// The device has reported an event.
    Event {
        /// Finger of the device.
        finger: u8,
        /// Its tick.
        tick: u32,
        /// Microseconds after the start of the tick's first scan.
        microseconds: u16,
        /// Its word in the protocol.
        kind: String,
    },
    /// A trial has ended with this record. Everything up to this line, and this many bytes of the telemetry, is whole.
    Record {
        /// The record.
        record: Box<TrialRecord>,
        /// Length of the telemetry up to its end.
        telemetry_bytes: u64,
    },
}

impl Entry {
    /// The entry of an update; none of telemetry, which has a file of its own.
    pub(super) fn of(update: &Update) -> Option<Self> {
        match update {
            Update::Telemetry(_) => None,
            Update::Event(ReceivedEvent { finger, event, .. }) => Some(Self::Event {
                finger: finger.unwrap_or(0),
                tick: event.tick,
                microseconds: event.microseconds,
                kind: event.kind.name().into(),
            }),
            other => Some(Self::Update(other.clone())),
        }
    }
}

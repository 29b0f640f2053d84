//! Events that the device reports.

use std::time::Duration;

use thermal_device::events::{DeviceEvent, DeviceEventKind};
use thermal_settings::Vocabulary as _;

/// An event as a client received it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReceivedEvent {
    /// The finger that it names; `None` from a device with one finger.
    pub finger: Option<u8>,
    /// Tick, microseconds from the start of its first scan, and what happened.
    pub event: DeviceEvent,
    /// Time by the link's clock at which it was received.
    pub at: Duration,
}

impl ReceivedEvent {
    /// Reads a line without its finger, and returns the event with its tick; `None` if it is no event.
    pub(super) fn parse(finger: Option<u8>, line: &str, at: Duration) -> Option<(Self, u32)> {
        let words: Vec<_> = line.split(' ').collect();
        let &["E", tick, microseconds, kind] = words.as_slice() else {
            return None;
        };
        let event = DeviceEvent {
            tick: tick.parse().ok()?,
            microseconds: microseconds.parse().ok()?,
            kind: DeviceEventKind::of_word(kind)?,
        };
        Some((Self { finger, event, at }, event.tick))
    }
}

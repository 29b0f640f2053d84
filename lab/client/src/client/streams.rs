//! Which fingers stream telemetry, and how many of their lines were lost.

use std::collections::BTreeMap;

/// The streams of telemetry that a client has asked for.
#[derive(Clone, Debug, Default)]
pub struct TelemetryStreams {
    /// Interval of all fingers that have none of their own, ms.
    interval_ms: u32,
    /// Interval of single fingers, ms.
    own_ms: BTreeMap<u8, u32>,
    /// Tick of the last line of each finger.
    last: BTreeMap<Option<u8>, u32>,
}

impl TelemetryStreams {
    /// Takes note of an interval, ms, 0 for none, of a finger or of all.
    pub fn set(&mut self, finger: Option<u8>, interval_ms: u32) {
        match finger {
            Some(finger) => {
                self.own_ms.insert(finger, interval_ms);
            }
            None => {
                self.interval_ms = interval_ms;
                self.own_ms.clear();
            }
        }
        self.last.clear();
    }

    /// Whether any finger streams.
    pub fn is_on(&self) -> bool {
        self.interval_ms > 0 || self.own_ms.values().any(|ms| *ms > 0)
    }

    /// Takes note of a line of telemetry; returns how many are missing before it.
    pub fn lost_before(&mut self, finger: Option<u8>, tick: u32) -> u32 {
        let own = finger
            .or(Some(0))
            .and_then(|finger| self.own_ms.get(&finger));
        let interval_ms = *own.unwrap_or(&self.interval_ms);
        let Some(last) = self.last.insert(finger, tick) else {
            return 0;
        };
        let passed = tick.wrapping_sub(last);
        // Ticks that go back are of a device that has restarted.
        if interval_ms == 0 || passed > u32::MAX / 2 {
            return 0;
        }
        (passed / interval_ms).saturating_sub(1)
    }
}

//! Which fingers stream telemetry, and how many of their lines were lost.

use std::collections::BTreeMap;

use thermal_device::TelemetryFields;

/// The streams of telemetry that a client has asked for.
#[derive(Clone, Debug, Default)]
pub struct TelemetryStreams {
    /// Interval of all fingers that have none of their own, ms.
    interval_ms: u32,
    /// Interval of single fingers, ms.
    own_ms: BTreeMap<u8, u32>,
    /// Fields of all fingers that have none of their own; `None` for all fields.
    fields: Option<TelemetryFields>,
    /// Fields of single fingers.
    own_fields: BTreeMap<u8, TelemetryFields>,
    /// Tick of the last line of each finger.
    last: BTreeMap<Option<u8>, u32>,
}

impl TelemetryStreams {
    /// Takes note of an interval, ms, 0 for none, and of the fields, of a finger or of all.
    pub fn set(&mut self, finger: Option<u8>, interval_ms: u32, fields: TelemetryFields) {
        match finger {
            Some(finger) => {
                self.own_ms.insert(finger, interval_ms);
                self.own_fields.insert(finger, fields);
            }
            None => {
                self.interval_ms = interval_ms;
                self.fields = Some(fields);
                self.own_fields.clear();
                self.own_ms.clear();
            }
        }
        self.last.clear();
    }

    /// The fields of a finger's telemetry.
    pub fn fields(&self, finger: Option<u8>) -> TelemetryFields {
        let own = finger.and_then(|finger| self.own_fields.get(&finger));
        own.copied().or(self.fields).unwrap_or(TelemetryFields::ALL)
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

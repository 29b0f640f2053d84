//! Which fingers stream telemetry, with which fields, and how many of their lines were lost.

use std::collections::BTreeMap;
use std::time::Duration;

use thermal_device::TelemetryFields;
use thermal_wire::telemetry::DEFAULT_FIELDS;

/// Time without telemetry after which a device that streams has stopped: this many intervals, and at least this time.
const SILENT_INTERVALS: u32 = 3;
const SILENT: Duration = Duration::from_millis(500);

/// Longest time between two lines of telemetry of a device that streams at an interval, ms.
pub fn longest_gap(interval_ms: u32) -> Duration {
    (SILENT_INTERVALS * Duration::from_millis(interval_ms.into())).max(SILENT)
}

/// What a finger streams.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// Interval, ms; 0 if it does not stream.
    pub interval_ms: u32,
    /// Fields of its lines.
    pub fields: TelemetryFields,
}

/// The streams of telemetry that a client has asked for.
#[derive(Clone, Debug)]
pub struct TelemetryStreams {
    /// That of all fingers that have none of their own.
    all: Stream,
    /// Those of single fingers.
    own: BTreeMap<u8, Stream>,
    /// When the fields of a finger, or of all, were last changed while it streamed, by the link's clock.
    changed_at: BTreeMap<Option<u8>, Duration>,
    /// Tick of the last line of each finger.
    last: BTreeMap<Option<u8>, u32>,
}

impl Default for TelemetryStreams {
    fn default() -> Self {
        Self {
            all: Stream { interval_ms: 0, fields: DEFAULT_FIELDS },
            own: BTreeMap::new(),
            changed_at: BTreeMap::new(),
            last: BTreeMap::new(),
        }
    }
}

impl TelemetryStreams {
    /// Takes note of what a finger or all stream from a time on, by the link's clock.
    pub fn set(&mut self, finger: Option<u8>, stream: Stream, at: Duration) {
        let changes = |old: &Stream| old.interval_ms > 0 && old.fields != stream.fields;
        let changed = match finger {
            Some(finger) => {
                let old = self.own.insert(finger, stream).unwrap_or(self.all);
                changes(&old)
            }
            None => {
                let changed = changes(&self.all) || self.own.values().any(changes);
                self.own.clear();
                self.all = stream;
                changed
            }
        };
        if changed {
            self.changed_at.insert(finger, at);
        }
        self.last.clear();
    }

    /// What a finger streams. A line without a finger is that of the only one.
    fn of(&self, finger: Option<u8>) -> Stream {
        let own = self.own.get(&finger.unwrap_or(0));
        *own.unwrap_or(&self.all)
    }

    /// The fields of a finger's telemetry.
    pub fn fields(&self, finger: Option<u8>) -> TelemetryFields {
        self.of(finger).fields
    }

    /// When the fields of a finger's telemetry were last changed while it streamed, by the link's clock.
    pub fn fields_changed_at(&self, finger: Option<u8>) -> Option<Duration> {
        let own = Some(finger.unwrap_or(0));
        let changes = [None, own].map(|key| self.changed_at.get(&key));
        changes.into_iter().flatten().max().copied()
    }

    /// Whether any finger streams.
    pub fn is_on(&self) -> bool {
        self.all.interval_ms > 0 || self.own.values().any(|own| own.interval_ms > 0)
    }

    /// Takes note of a line of telemetry; returns how many are missing before it.
    pub fn lost_before(&mut self, finger: Option<u8>, tick: u32) -> u32 {
        let interval_ms = self.of(finger).interval_ms;
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

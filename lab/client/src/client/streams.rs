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

/// What a finger streams, or has streamed.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// Interval, ms; 0 if it has ended.
    pub interval_ms: u32,
    /// Fields of its lines.
    pub fields: TelemetryFields,
    /// When it began or ended, by the link's clock.
    pub since: Duration,
}

impl Stream {
    /// Ends it. Lines that wait still have its fields.
    const fn end(&mut self, at: Duration) {
        if self.interval_ms > 0 {
            (self.interval_ms, self.since) = (0, at);
        }
    }

    /// Until when its lines were reported if those of the next one have other fields.
    fn changed_at(&self, next: &Self) -> Option<Duration> {
        let until = if self.interval_ms > 0 { next.since } else { self.since };
        (self.fields != next.fields).then_some(until)
    }
}

/// The streams of telemetry that a client has asked for.
#[derive(Clone, Debug, Default)]
pub struct TelemetryStreams {
    /// That of all fingers that have none of their own.
    all: Option<Stream>,
    /// Those of single fingers.
    own: BTreeMap<u8, Stream>,
    /// When the fields of a finger, or of all, were last changed while it streamed, by the link's clock.
    changed_at: BTreeMap<Option<u8>, Duration>,
    /// Tick of the last line of each finger.
    last: BTreeMap<Option<u8>, u32>,
}

impl TelemetryStreams {
    /// Takes note of what a finger or all stream from now on, or that they end.
    pub fn set(&mut self, finger: Option<u8>, stream: Stream) {
        self.last.clear();
        if stream.interval_ms == 0 {
            if let Some((finger, all)) = finger.zip(self.all) {
                self.own.entry(finger).or_insert(all);
            }
            let (all, own) = (self.all.iter_mut(), self.own.iter_mut());
            let all = all.filter(|_| finger.is_none());
            let own = own.filter(|(key, _)| finger.is_none_or(|finger| finger == **key));
            all.chain(own.map(|(_, own)| own)).for_each(|ended| ended.end(stream.since));
            return;
        }
        let changed_at = match finger {
            Some(finger) => {
                let old = self.own.insert(finger, stream).or(self.all);
                old.and_then(|old| old.changed_at(&stream))
            }
            None => {
                let old = self.all.iter().chain(self.own.values());
                let changed_at = old.filter_map(|old| old.changed_at(&stream)).max();
                self.own.clear();
                self.all = Some(stream);
                changed_at
            }
        };
        if let Some(at) = changed_at {
            self.changed_at.insert(finger, at);
        }
    }

    /// What a finger streams. A line without a finger is that of the only one.
    fn of(&self, finger: Option<u8>) -> Option<&Stream> {
        self.own.get(&finger.unwrap_or(0)).or(self.all.as_ref())
    }

    /// The fields of a finger's telemetry.
    pub fn fields(&self, finger: Option<u8>) -> TelemetryFields {
        self.of(finger).map_or(DEFAULT_FIELDS, |stream| stream.fields)
    }

    /// When the fields of a finger's telemetry were last changed while it streamed, by the link's clock.
    pub fn fields_changed_at(&self, finger: Option<u8>) -> Option<Duration> {
        let own = Some(finger.unwrap_or(0));
        let changes = [None, own].map(|key| self.changed_at.get(&key));
        changes.into_iter().flatten().max().copied()
    }

    /// Whether any finger streams.
    pub fn is_on(&self) -> bool {
        self.all.iter().chain(self.own.values()).any(|stream| stream.interval_ms > 0)
    }

    /// Takes note of a line of telemetry; returns how many are missing before it.
    pub fn lost_before(&mut self, finger: Option<u8>, tick: u32) -> u32 {
        let interval_ms = self.of(finger).map_or(0, |stream| stream.interval_ms);
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

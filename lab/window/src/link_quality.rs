//! How well telemetry comes, and how late it is on the screen.

use std::time::Duration;

/// What is known of the line to the device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkQuality {
    /// Lines of telemetry that came.
    pub received: u64,
    /// Lines that are missing, by their ticks.
    pub lost: u64,
    /// When the last line came.
    pub last_at: Option<Duration>,
    /// When a line was last missing.
    pub lost_at: Option<Duration>,
}

impl LinkQuality {
    pub(crate) fn add(&mut self, lost_before: u32, at: Duration) {
        self.received += 1;
        self.last_at = Some(at);
        if lost_before > 0 {
            self.lost += u64::from(lost_before);
            self.lost_at = Some(at);
        }
    }

    /// How long no telemetry has come; `None` if none ever came.
    pub fn silent_for(&self, now: Duration) -> Option<Duration> {
        Some(now.saturating_sub(self.last_at?))
    }
}

/// Upper ends of the classes of latencies, ms; the last class has none.
const CLASSES_MS: [u32; 11] = [2, 5, 10, 15, 20, 25, 30, 40, 60, 100, 250];

/// Time from an update's arrival at the window to the frame that draws it: of each frame, that of its oldest update. What
/// the graphics driver and the monitor add is not in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScreenLatency {
    classes: [u64; CLASSES_MS.len() + 1],
    longest: Duration,
}

impl ScreenLatency {
    /// Takes note of a frame.
    pub fn add(&mut self, latency: Duration) {
        let ms = latency.as_secs_f64() * 1e3;
        let class = CLASSES_MS.iter().take_while(|end| ms > f64::from(**end)).count();
        self.classes[class] += 1;
        self.longest = self.longest.max(latency);
    }

    /// Number of frames.
    pub fn frames(&self) -> u64 {
        self.classes.iter().sum()
    }

    /// A latency, ms, that so many per cent of the frames do not exceed; `None` without frames.
    pub fn percentile_ms(&self, percent: u64) -> Option<u32> {
        let frames = self.frames();
        let mut seen = 0;
        let mut ends = CLASSES_MS.into_iter();
        for count in self.classes {
            seen += count;
            let end = ends.next();
            if frames > 0 && seen * 100 >= frames * percent {
                return Some(end.unwrap_or_else(|| self.longest_ms()));
            }
        }
        None
    }

    /// The longest latency, ms, rounded up.
    pub fn longest_ms(&self) -> u32 {
        u32::try_from(self.longest.as_micros().div_ceil(1000)).unwrap_or(u32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_ends_of_classes() {
        let mut latency = ScreenLatency::default();
        assert_eq!(latency.percentile_ms(50), None);
        for ms in [1, 4, 8, 8, 8, 8, 8, 9, 9, 400] {
            latency.add(Duration::from_millis(ms));
        }
        assert_eq!(latency.percentile_ms(10), Some(2));
        assert_eq!(latency.percentile_ms(50), Some(10));
        assert_eq!(latency.percentile_ms(100), Some(400));
        assert_eq!(latency.frames(), 10);
    }
}

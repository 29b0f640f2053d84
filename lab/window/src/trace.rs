//! The last seconds of a finger's telemetry.

use std::collections::VecDeque;

use thermal_client::client::Telemetry;
use thermal_device::TICK_S;

/// Length of the trace, s.
pub const TRACE_S: f64 = 20.0;
/// Smallest distance of two samples, ticks; with the length it bounds the memory at any rate of telemetry.
const DISTANCE_MIN_TICKS: u32 = 5;

/// The last 20 s, as lines of telemetry with all that the device reports.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    samples: VecDeque<Telemetry>,
}

impl Trace {
    /// Adds a line of telemetry, unless it is too close to the last one.
    pub fn push(&mut self, telemetry: &Telemetry) {
        if let Some(last) = self.samples.back() {
            let passed = telemetry.tick.wrapping_sub(last.tick);
            if passed > u32::MAX / 2 {
                // Ticks that go back are of a device that has restarted.
                self.samples.clear();
            } else if passed < DISTANCE_MIN_TICKS {
                return;
            }
        }
        self.samples.push_back(*telemetry);
        while self.samples.front().is_some_and(|first| self.age_s(first) > TRACE_S) {
            self.samples.pop_front();
        }
    }

    /// The samples, the oldest first.
    pub fn samples(&self) -> impl DoubleEndedIterator<Item = &Telemetry> + Clone {
        self.samples.iter()
    }

    /// By how much a sample is older than the newest one, s.
    pub fn age_s(&self, sample: &Telemetry) -> f64 {
        let newest = self.samples.back().map_or(sample.tick, |last| last.tick);
        f64::from(newest.wrapping_sub(sample.tick)) * TICK_S
    }

    /// Mean of the skin over the last second, °C; `None` if the device does not know it.
    pub fn skin_c(&self) -> Option<f64> {
        let last = self.samples.iter().rev();
        let last = last.take_while(|sample| self.age_s(sample) <= 1.0);
        let known = last.filter_map(|sample| sample.skin_c);
        let (sum, count) = known.fold((0.0, 0), |(sum, count), skin_c| (sum + skin_c, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

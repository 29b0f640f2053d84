//! The last seconds of a finger's telemetry.

use std::collections::VecDeque;

use thermal_client::client::Telemetry;
use thermal_device::TICK_S;

/// Length of the trace, s.
pub const TRACE_S: f64 = 20.0;
/// Smallest distance of two samples, ticks; with the length it bounds the memory at any rate of telemetry.
const DISTANCE_MIN_TICKS: u32 = 5;

/// A sample; what is not known is not a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Tick of the device.
    pub tick: u32,
    /// Set-point, °C.
    pub setpoint_c: f32,
    /// Display, °C.
    pub display_c: f32,
    /// Skin, °C.
    pub skin_c: f32,
    /// Force, N.
    pub force_n: f32,
    /// Demanded current, A; positive cools.
    pub demand_a: f32,
    /// Measured current with the sign of the demanded one, A.
    pub current_a: f32,
}

impl Sample {
    fn of(telemetry: &Telemetry) -> Self {
        let number = |value: Option<f64>| value.map_or(f32::NAN, |value| value as f32);
        let demand_a = number(telemetry.demand_a);
        // A demand that is not known says nothing about the direction.
        let sign = if demand_a < 0.0 { -1.0 } else { 1.0 };
        Self {
            tick: telemetry.tick,
            setpoint_c: number(telemetry.setpoint_c),
            display_c: number(telemetry.display_c),
            skin_c: number(telemetry.skin_c),
            force_n: number(telemetry.force_n),
            demand_a,
            current_a: sign * number(telemetry.current_a),
        }
    }
}

/// The last 20 s.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    samples: VecDeque<Sample>,
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
        self.samples.push_back(Sample::of(telemetry));
        while self.samples.front().is_some_and(|first| self.age_s(first) > TRACE_S) {
            self.samples.pop_front();
        }
    }

    /// The samples, the oldest first.
    pub fn samples(&self) -> impl DoubleEndedIterator<Item = &Sample> + Clone {
        self.samples.iter()
    }

    /// By how much a sample is older than the newest one, s.
    pub fn age_s(&self, sample: &Sample) -> f64 {
        let newest = self.samples.back().map_or(sample.tick, |last| last.tick);
        f64::from(newest.wrapping_sub(sample.tick)) * TICK_S
    }

    /// Mean of the skin over the last second, °C; `None` if the device does not know it.
    pub fn skin_c(&self) -> Option<f64> {
        let last = self.samples.iter().rev();
        let last = last.take_while(|sample| self.age_s(sample) <= 1.0);
        let known = last.filter(|sample| !sample.skin_c.is_nan());
        let (sum, count) = known
            .fold((0.0, 0), |(sum, count), sample| (sum + f64::from(sample.skin_c), count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

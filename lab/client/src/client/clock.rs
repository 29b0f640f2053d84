//! Device ticks against the link's clock.
//!
//! A line arrives later than the tick that it names, by the time on the line and by delays of USB and operating system, which
//! are irregular but never negative. So the earliest arrivals of each span of time tell where the ticks lie:
//!
//! ```text
//! arrival - tick      .    .                 The minimum of each span is kept. Their slope (median of the slopes of all
//!        |  .    . .     .    .  .  .        pairs) is the drift of the clocks; the line with this slope through their
//!        | __.______.__.________.____.__     median is the estimate; their distance from it is its error.
//!        +------------------------------ t
//! ```
//!
//! A delay that all lines have cannot be seen from one end: it stays in the offset, and is not part of the error.
//!
//! Without checksums a damaged digit may give a line a wrong tick. A line whose tick does not follow from the one before
//! counts only if the next line agrees with it, as those of a device that has restarted do.

use std::time::Duration;

/// Ticks per second.
const TICK_S: f64 = thermal_settings::TICK_S;
/// Length of a span at first, s, and number of spans that are kept; then two become one of twice the length.
const SPAN_S: f64 = 0.5;
const SPANS_MAX: usize = 64;
/// By how much a tick may differ from what has passed since the latest one: lines are late, and those of several fingers
/// overtake each other.
const DIFFERENCE_MAX_TICKS: f64 = 200.0;
/// By how much the rates of two clocks may differ. The device's internal oscillator has 1 %.
const RATE_TOLERANCE: f64 = 0.03;

/// Estimate of when ticks happen by the link's clock. It begins anew when the device restarts.
#[derive(Clone, Debug)]
pub struct DeviceClock {
    /// Restarts of the device that were seen.
    restarts: u32,
    /// The latest tick, and the ticks before it that its 32 bits do not count.
    latest: Option<Arrival>,
    wrapped: u64,
    /// The last line, if its tick does not follow from the latest one.
    doubted: Option<Arrival>,
    span_s: f64,
    /// The earliest arrival of each span: tick time, s, and how much later it arrived, s.
    minima: Vec<(f64, f64)>,
}

/// A tick and when its line arrived.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    tick: u32,
    at: Duration,
}

impl Arrival {
    /// Ticks from an earlier arrival to this one; negative if they go back.
    const fn ticks_since(self, before: Self) -> i32 {
        self.tick.wrapping_sub(before.tick).cast_signed()
    }

    /// Whether one run of the device can have sent both.
    fn follows(self, before: Self) -> bool {
        let passed = self.at.saturating_sub(before.at).as_secs_f64() / TICK_S;
        let ticks = f64::from(self.ticks_since(before));
        (-DIFFERENCE_MAX_TICKS..=passed * (1.0 + RATE_TOLERANCE) + DIFFERENCE_MAX_TICKS)
            .contains(&ticks)
    }
}

/// When a tick happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickTime {
    /// Time by the link's clock, s, and the delay that all lines have.
    pub at_s: f64,
    /// Largest distance of the earliest arrivals from the estimate, s.
    pub error_s: f64,
    /// By how much the device's clock is slower than the link's, parts in a million.
    pub drift_ppm: f64,
}

impl Default for DeviceClock {
    fn default() -> Self {
        Self {
            restarts: 0,
            latest: None,
            wrapped: 0,
            doubted: None,
            span_s: SPAN_S,
            minima: Vec::new(),
        }
    }
}

impl DeviceClock {
    /// Restarts of the device that its ticks have shown.
    pub const fn restarts(&self) -> u32 {
        self.restarts
    }

    /// Forgets the estimate: the device has restarted.
    pub fn restart(&mut self) {
        *self = Self { restarts: self.restarts + 1, ..Self::default() };
    }

    /// Takes note of a line that names a tick and arrived at a time of the link's clock.
    pub fn observe(&mut self, tick: u32, at: Duration) {
        let line = Arrival { tick, at };
        if let Some(latest) = self.latest.filter(|latest| !line.follows(*latest)) {
            let doubted = self.doubted.replace(line);
            let Some(first) = doubted.filter(|first| line.follows(*first)) else {
                return;
            };
            // Ticks that jump ahead are of no restart: those before were wrong.
            let restarts = self.restarts + u32::from(line.ticks_since(latest) < 0);
            *self = Self { restarts, ..Self::default() };
            self.add(first);
        }
        self.doubted = None;
        self.add(line);
    }

    fn add(&mut self, line: Arrival) {
        let Arrival { tick, at } = line;
        let ahead = self.latest.is_none_or(|latest| {
            if tick < latest.tick && line.ticks_since(latest) > 0 {
                self.wrapped += 1 << 32;
            }
            line.ticks_since(latest) >= 0
        });
        if ahead {
            self.latest = Some(line);
        }
        let tick_s = self.tick_s(tick);
        let late_s = at.as_secs_f64() - tick_s;
        let span = (tick_s / self.span_s).floor();
        match self.minima.last_mut() {
            Some(last) if (last.0 / self.span_s).floor() >= span => {
                if late_s < last.1 {
                    *last = (tick_s, late_s);
                }
            }
            _ => self.minima.push((tick_s, late_s)),
        }
        if self.minima.len() > SPANS_MAX {
            self.halve();
        }
    }

    /// Doubles the length of a span: of the minima of two spans the less late one stays.
    fn halve(&mut self) {
        self.span_s *= 2.0;
        let mut merged: Vec<(f64, f64)> = Vec::new();
        for &(tick_s, late_s) in &self.minima {
            match merged.last_mut() {
                Some(last) if (last.0 / self.span_s).floor() == (tick_s / self.span_s).floor() => {
                    if late_s < last.1 {
                        *last = (tick_s, late_s);
                    }
                }
                _ => merged.push((tick_s, late_s)),
            }
        }
        self.minima = merged;
    }

    fn tick_s(&self, tick: u32) -> f64 {
        let after_wrap = self.latest.is_some_and(|latest| {
            tick > latest.tick && tick.wrapping_sub(latest.tick) > u32::MAX / 2 && self.wrapped > 0
        });
        let wrapped = self.wrapped - if after_wrap { 1 << 32 } else { 0 };
        (wrapped + u64::from(tick)) as f64 * TICK_S
    }

    /// When the tick of a line happened that arrived at a time of the link's clock: what has arrived has happened. `None` before the first
    /// telemetry.
    pub fn time_of_arrived(&self, tick: u32, at: Duration) -> Option<TickTime> {
        let time = self.time_of(tick)?;
        Some(TickTime { at_s: time.at_s.min(at.as_secs_f64()), ..time })
    }

    /// When a tick since the device's last restart happened; `None` before its first telemetry.
    pub fn time_of(&self, tick: u32) -> Option<TickTime> {
        let &(last_s, _) = self.minima.last()?;
        // The span that is not complete has not seen its earliest arrival yet.
        let complete = match self.minima.as_slice() {
            [complete @ .., _] if complete.len() >= 2 => complete,
            all => all,
        };
        let in_time = in_time(complete);
        let slopes = in_time.iter().enumerate().flat_map(|(i, a)| {
            let later = in_time.iter().skip(i + 1);
            later.map(move |b| (b.1 - a.1) / (b.0 - a.0))
        });
        // Two spans alone say little of a drift of some parts in a million.
        let is_enough = in_time.len() >= 3;
        let drift = median(slopes.collect()).filter(|_| is_enough).unwrap_or(0.0);
        let offsets = in_time.iter().map(|(t_s, late_s)| late_s - drift * (t_s - last_s));
        let offset_s = if is_enough {
            median(offsets.clone().collect())?
        } else {
            offsets.clone().reduce(f64::min)?
        };
        let errors_s = offsets.map(|one_s| (one_s - offset_s).abs());
        let tick_s = self.tick_s(tick);
        Some(TickTime {
            at_s: tick_s + offset_s + drift * (tick_s - last_s),
            error_s: errors_s.fold(0.0, f64::max),
            drift_ppm: 1e6 * drift,
        })
    }
}

/// The minima that are less late than the rates of two clocks allow, by all others. Where all lines of a span were late, as those that have
/// waited while the computer slept, they say nothing of the ticks.
fn in_time(minima: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let is_in_time = |one: &&(f64, f64)| {
        minima.iter().all(|other| one.1 - other.1 <= RATE_TOLERANCE * (one.0 - other.0).abs())
    };
    minima.iter().filter(is_in_time).copied().collect()
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

//! Monitors the rate of the control ticks by a second counter.

/// Width of the counter that ticks are compared with, bits: that of SysTick, the core's timer.
const COUNTER_BITS: u32 = 24;
/// Divisor of the tick's period that gives how early or late a tick may be: 4 allows a quarter of a period.
const TOLERANCE_DIVISOR: u32 = 4;

/// Predicts when each control tick is due, by a hardware counter that counts down and wraps, and that shares no timer
/// with the ticks. A tick that is not on time stops the sampling and trips all fingers by
/// [`Fault::Sampling`](super::Fault::Sampling).
///
/// Counter and ticks derive from one oscillator, so the jitter of single ticks never adds up, but a wrong rate does:
/// half a percent becomes a quarter of a period after 50 ticks, and a rate that is wrong by a factor of ten is detected
/// at once.
#[derive(Clone, Copy, Debug)]
pub struct TickRateMonitor {
    /// Counts from tick to tick, in the upper 24 bits of the word, so that sums wrap where the counter does.
    period: u32,
    /// Value of the counter at which the last tick was due, negated and in the upper 24 bits; `None` before the first
    /// tick, which is due when it comes.
    due: Option<u32>,
}

impl TickRateMonitor {
    /// A monitor of ticks that are `period` counts of the counter apart, below 2^24; created at the start, before the
    /// first tick.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self {
            period: period << (u32::BITS - COUNTER_BITS),
            due: None,
        }
    }

    /// Compares a tick with its due time, by `count`, the counter's value when the tick came; returns whether the tick
    /// was early or late by a quarter of a period at most. To be called once in each tick.
    ///
    /// A tick that is off by half a turn of the counter or more may be taken for another one; the watchdogs detect
    /// that.
    pub fn tick_is_due(&mut self, count: u32) -> bool {
        let now = (count << (u32::BITS - COUNTER_BITS)).wrapping_neg();
        let due = self.due.map_or(now, |due| due.wrapping_add(self.period));
        self.due = Some(due);
        now.wrapping_sub(due).cast_signed().unsigned_abs() <= self.period / TOLERANCE_DIVISOR
    }
}

#[cfg(test)]
mod tests {
    use super::TickRateMonitor;

    /// A millisecond of 180 MHz.
    const PERIOD: u32 = 180_000;
    const ROUND: u64 = 1 << 24;

    /// Number of the first tick that is off, of `ticks` ticks that come at these cycles.
    fn first_off(ticks: u64, cycle: impl Fn(u64) -> u64) -> Option<u64> {
        let mut monitor = TickRateMonitor::new(PERIOD);
        let shown = |cycle: u64| (ROUND - 1 - (cycle + 123_456) % ROUND) as u32;
        (0..ticks).find(|n| !monitor.tick_is_due(shown(cycle(*n))))
    }

    #[test]
    fn ticks_with_jitter_pass_for_an_hour() {
        let period = u64::from(PERIOD);
        assert_eq!(first_off(3_600_000, |n| n * period), None);
        assert_eq!(
            first_off(3_600_000, |n| n * period + n * 7919 % 44_000),
            None
        );
        // A first tick that is late makes the others early.
        assert_eq!(
            first_off(1000, |n| n * period + if n == 0 { 44_000 } else { 0 }),
            None
        );
    }

    #[test]
    fn a_tick_that_is_off_by_more_than_a_quarter_of_its_period_is_detected() {
        let period = u64::from(PERIOD);
        for n in [1, 93, 94, 1000] {
            let with = |off: i64| {
                first_off(2000, |tick| {
                    (tick * period + period).saturating_add_signed(if tick == n { off } else { 0 })
                })
            };
            assert_eq!((with(45_000), with(-45_000)), (None, None));
            assert_eq!((with(45_001), with(-45_001)), (Some(n), Some(n)));
        }
    }

    /// TIM2 counts 5625 periods of its clock from scan to scan; a tick has 16 scans.
    #[test]
    fn a_wrong_rate_shows_within_50_ms() {
        let of = |scan: u64| {
            let tick = scan * 16 * 2;
            let n = first_off(10_000, |n| n * tick)?;
            Some((n * tick) as f64 / 180e3)
        };
        assert_eq!(of(5625), None);
        for bit in 5..=17 {
            let scan = 1 + (5624 ^ 1 << bit);
            let ms = of(scan).expect("off");
            assert!(ms <= 50.0, "{scan}: {ms} ms");
        }
        // The smallest that a bit can do: 0.02 %.
        assert!(of(5624).is_some_and(|ms| ms < 1500.0));
        // Prescaler: half the rate and less, up to where the window watchdog is first.
        for divider in [2, 3, 5, 9, 17, 33] {
            assert!(
                of(5625 * divider).is_some_and(|ms| ms <= 50.0),
                "1/{divider}"
            );
        }
        assert!(of(5625 * 102 / 100).is_some_and(|ms| ms < 14.0), "2 %");
    }

    #[test]
    fn a_counter_that_stands_or_runs_at_an_eighth_shows_at_once() {
        assert_eq!(first_off(10, |_| 77), Some(1));
        assert_eq!(first_off(10, |n| n * u64::from(PERIOD) / 8), Some(1));
    }
}

//! Monitors the rate of the control ticks by a second counter.

/// Width in bits of SysTick, the core's timer, with whose count the time of each tick is compared.
const SYSTICK_BITS: u32 = 24;
/// Divisor of the tick's period that gives how early or late a tick may be: 4 allows a quarter of a period.
const TICK_TOLERANCE_DIVISOR: u32 = 4;

/// Checks that each control tick comes on time, by SysTick: a 24-bit hardware counter that counts the core clock down
/// and wraps, independent of the timer that generates the ticks. If a tick is early or late by more than a quarter of
/// its period, the board stops sampling and trips the stations of all fingers by
/// [`Fault::Sampling`](super::Fault::Sampling).
///
/// Each tick is due a whole number of periods after the first, and SysTick and the ticks derive from one oscillator. So
/// the jitter of single ticks does not accumulate, but a wrong rate does: 0.5 % becomes a quarter of a period after 50
/// ticks, and a rate that is wrong by a factor of ten is detected at the next tick.
#[derive(Clone, Copy, Debug)]
pub struct TickRateMonitor {
    /// SysTick counts from one tick to the next, in the upper 24 bits of the word, so that its arithmetic wraps where
    /// SysTick wraps.
    period: u32,
    /// SysTick's value at which the last tick was due, negated because SysTick counts down, and in the upper 24 bits of
    /// the word. `None` before the first tick, which is always on time.
    due: Option<u32>,
}

impl TickRateMonitor {
    /// A monitor for ticks that are `period` counts of SysTick apart (below 2^24; 180 000 for 1 ms at 180 MHz). Created
    /// before the first tick.
    pub const fn new(period: u32) -> Self {
        Self { period: period << (u32::BITS - SYSTICK_BITS), due: None }
    }

    /// Returns whether this tick has come within a quarter of a period of the time at which it was due: the time of the
    /// first tick plus a whole number of periods. `count` is the present value of SysTick, which counts down. To be
    /// called once in each tick; the first call sets the schedule and returns true.
    ///
    /// A tick that is late by a whole turn of SysTick (2^24 counts, 93 ms at 180 MHz) seems to be on time; the window
    /// watchdog has reset the device by then, after 47 ms.
    pub fn tick_is_on_schedule(&mut self, count: u32) -> bool {
        let now = (count << (u32::BITS - SYSTICK_BITS)).wrapping_neg();
        let due = self.due.map_or(now, |due| due.wrapping_add(self.period));
        self.due = Some(due);
        now.wrapping_sub(due).cast_signed().unsigned_abs() <= self.period / TICK_TOLERANCE_DIVISOR
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
        (0..ticks).find(|n| !monitor.tick_is_on_schedule(shown(cycle(*n))))
    }

    #[test]
    fn ticks_with_jitter_pass_for_an_hour() {
        let period = u64::from(PERIOD);
        assert_eq!(first_off(3_600_000, |n| n * period), None);
        assert_eq!(first_off(3_600_000, |n| n * period + n * 7919 % 44_000), None);
        // A first tick that is late makes the others early.
        assert_eq!(first_off(1000, |n| n * period + if n == 0 { 44_000 } else { 0 }), None);
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
            assert!(of(5625 * divider).is_some_and(|ms| ms <= 50.0), "1/{divider}");
        }
        assert!(of(5625 * 102 / 100).is_some_and(|ms| ms < 14.0), "2 %");
    }

    #[test]
    fn a_counter_that_stands_or_runs_at_an_eighth_shows_at_once() {
        assert_eq!(first_off(10, |_| 77), Some(1));
        assert_eq!(first_off(10, |n| n * u64::from(PERIOD) / 8), Some(1));
    }
}

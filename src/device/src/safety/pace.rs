//! Ticks against a counter that has no part in them.

/// Bits of the counter: SysTick's.
const BITS: u32 = 24;
/// Part of a period that a tick may be off, either way.
const PART: u32 = 4;

/// When ticks are due, by a counter that counts down without end.
///
/// Counter and ticks come from one oscillator, so that what one tick is late never adds up; what a wrong rate is off does.
/// Half a percent has become a quarter of a period after 50 ticks, a rate that is 10 times wrong shows at once.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Of a tick, in the upper bits, so that all wraps where the counter does.
    period: u32,
    /// When the last tick was due; none before the first, which is when it comes.
    due: Option<u32>,
}

impl Pace {
    /// Ticks that are `period` counts apart, of the counter's 2^24.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self {
            period: period << (u32::BITS - BITS),
            due: None,
        }
    }

    /// Takes one tick, with what the counter shows; whether the tick has come when it was due.
    ///
    /// One that is off by half a round of the counter or more may be taken for another: that is a watchdog's part.
    pub fn keeps(&mut self, count: u32) -> bool {
        let now = (count << (u32::BITS - BITS)).wrapping_neg();
        let due = self.due.map_or(now, |due| due.wrapping_add(self.period));
        self.due = Some(due);
        now.wrapping_sub(due).cast_signed().unsigned_abs() <= self.period / PART
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    /// A millisecond of 180 MHz.
    const PERIOD: u32 = 180_000;
    const ROUND: u64 = 1 << 24;

    /// Ticks until one is off, of so many, that come at these cycles.
    fn until_off(ticks: u64, cycle: impl Fn(u64) -> u64) -> Option<u64> {
        let mut pace = Pace::new(PERIOD);
        let shown = |cycle: u64| (ROUND - 1 - (cycle + 123_456) % ROUND) as u32;
        (0..ticks).find(|n| !pace.keeps(shown(cycle(*n))))
    }

    #[test]
    fn ticks_that_come_in_time_pass_for_an_hour_though_each_is_late_by_something() {
        let period = u64::from(PERIOD);
        assert_eq!(until_off(3_600_000, |n| n * period), None);
        assert_eq!(
            until_off(3_600_000, |n| n * period + n * 7919 % 44_000),
            None
        );
        // A first tick that is late makes the others early.
        assert_eq!(
            until_off(1000, |n| n * period + if n == 0 { 44_000 } else { 0 }),
            None
        );
    }

    #[test]
    fn one_tick_that_is_off_by_more_than_a_quarter_shows() {
        let period = u64::from(PERIOD);
        for n in [1, 93, 94, 1000] {
            let with = |off: i64| {
                until_off(2000, |tick| {
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
            let n = until_off(10_000, |n| n * tick)?;
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
        assert_eq!(until_off(10, |_| 77), Some(1));
        assert_eq!(until_off(10, |n| n * u64::from(PERIOD) / 8), Some(1));
    }
}

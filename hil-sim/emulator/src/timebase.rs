//! Conversion between CPU cycles and time, across changes of HCLK.

const PS_PER_S: u128 = 1_000_000_000_000;

/// Relates cycles to picoseconds, both since power-up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Timebase {
    /// Cycle and time at which the present clock began.
    cycle: u64,
    ps: u64,
    hclk_hz: u32,
}

impl Timebase {
    pub const fn new(hclk_hz: u32) -> Self {
        Self { cycle: 0, ps: 0, hclk_hz }
    }

    /// Sets the clock from cycle `now` on.
    pub fn set_clock(&mut self, hclk_hz: u32, now: u64) {
        if hclk_hz != self.hclk_hz {
            *self = Self { cycle: now, ps: self.ps_at(now), hclk_hz };
        }
    }

    /// Time of a cycle, ps; the cycle is not before the last change of the clock.
    pub fn ps_at(&self, cycle: u64) -> u64 {
        let cycles = u128::from(cycle.saturating_sub(self.cycle));
        self.ps + (cycles * PS_PER_S / u128::from(self.hclk_hz)) as u64
    }

    /// First cycle at or after a time, if the clock stays as it is.
    pub fn cycle_at(&self, ps: u64) -> u64 {
        let ps = u128::from(ps.saturating_sub(self.ps));
        self.cycle + (ps * u128::from(self.hclk_hz)).div_ceil(PS_PER_S) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_lasts_a_period_of_its_clock() {
        let mut time = Timebase::new(16_000_000);
        assert_eq!(time.ps_at(16), 1_000_000);
        time.set_clock(180_000_000, 1600);
        assert_eq!(time.ps_at(1600 + 180), 101_000_000);
        assert_eq!(time.cycle_at(101_000_000), 1780);
    }

    #[test]
    fn cycle_to_time_and_back_gives_the_same_cycle() {
        let time = Timebase::new(180_000_000);
        for cycle in [1, 2, 7, 1_234_567, 90_000 * 123_456 + 1] {
            assert_eq!(time.cycle_at(time.ps_at(cycle)), cycle);
            assert_eq!(time.cycle_at(time.ps_at(cycle) + 500_000_000), cycle + 90_000);
        }
    }
}

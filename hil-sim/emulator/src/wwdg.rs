//! Window watchdog (RM0390 chapter 21), clocked by PCLK1.
//!
//! Prescaler and down-counter run freely while the peripheral's clock is on, enabled or not. A refresh reloads the
//! counter but not the prescaler, so a time-out lies between `T[5:0]` and `T[5:0] + 1` periods of
//! 4096 * 2^WDGTB PCLK1 cycles; the manual's formula is the upper bound.
use super::stop::{Answer, Refusal, only};

const WDGA: u32 = 1 << 7;
const T6: u32 = 1 << 6;
const EWI: u32 = 1 << 9;
/// Fixed part of the prescaler, PCLK1 cycles.
const PRESCALER: u64 = 4096;
/// Reset value of the counter and of the window.
const TOP: u32 = 0x7f;

#[derive(Default)]
pub(crate) struct Wwdg {
    active: bool,
    /// The counter at `synced_to`, 0 to 0x7f.
    count: u32,
    cfr: u32,
    early_wakeup: bool,
    /// CPU cycles per PCLK1 cycle; `None` while the peripheral's clock is off.
    divider: Option<u64>,
    /// Cycle at which the prescaler was 0; with the clock off, the PCLK1 cycles that it had counted.
    zero_at: u64,
    synced_to: u64,
    /// Cycle of the early wake-up or of the reset, whichever comes first.
    pub due: u64,
}

impl Wwdg {
    pub fn new() -> Self {
        Self { count: TOP, cfr: TOP, due: u64::MAX, ..Self::default() }
    }

    /// Back to the reset values; the clock stays.
    pub fn reset(&mut self, now: u64) {
        let divider = self.divider;
        *self = Self::new();
        self.set_clock(divider, now);
    }

    /// Whether it resets the chip unless it is refreshed.
    pub const fn is_running(&self) -> bool {
        self.active && self.divider.is_some()
    }

    /// Interrupt request (early wake-up).
    pub const fn request(&self) -> bool {
        self.early_wakeup && self.cfr & EWI != 0
    }

    /// Sets the CPU cycles per PCLK1 cycle, or stops the clock, at `now`; prescaler and counter keep their values.
    pub fn set_clock(&mut self, divider: Option<u64>, now: u64) {
        if divider == self.divider {
            return;
        }
        self.sync(now);
        let counted = match self.divider {
            Some(old) => now.wrapping_sub(self.zero_at) / old % (PRESCALER << 3),
            None => self.zero_at,
        };
        self.divider = divider;
        self.zero_at = match divider {
            Some(new) => now.wrapping_sub(counted * new),
            None => counted,
        };
        self.synced_to = now;
        self.schedule();
    }

    /// CPU cycles from one count to the next.
    fn step(&self) -> Option<u64> {
        self.divider.map(|divider| divider * (PRESCALER << (self.cfr >> 7 & 3)))
    }

    /// Brings the counter up to `now`. `true`: it has passed 0x40, and the watchdog resets the chip.
    pub fn sync(&mut self, now: u64) -> bool {
        let mut expired = false;
        if let Some(step) = self.step() {
            let ticks = |to: u64| to.wrapping_sub(self.zero_at) / step;
            let passed = ticks(now) - ticks(self.synced_to);
            let to_early_wakeup = u64::from(self.count.wrapping_sub(T6) & TOP);
            self.early_wakeup |= passed > 0 && to_early_wakeup > 0 && passed >= to_early_wakeup;
            expired = self.active && passed > u64::from(self.count.saturating_sub(T6));
            self.count = (u64::from(self.count).wrapping_sub(passed) & u64::from(TOP)) as u32;
        }
        self.synced_to = now;
        self.schedule();
        expired
    }

    fn schedule(&mut self) {
        self.due = u64::MAX;
        let Some(step) = self.step() else { return };
        let next = self.synced_to - self.synced_to.wrapping_sub(self.zero_at) % step + step;
        let at = |ticks: u32| next + u64::from(ticks - 1) * step;
        if self.active && self.count & T6 != 0 {
            self.due = at(self.count - T6 + 1);
        }
        let to_early_wakeup = self.count.wrapping_sub(T6) & TOP;
        if self.cfr & EWI != 0 && !self.early_wakeup && to_early_wakeup > 0 {
            self.due = self.due.min(at(to_early_wakeup));
        }
    }

    pub fn read(&mut self, offset: u32, now: u64) -> Answer<u32> {
        self.sync(now);
        match offset {
            0x00 => Ok(self.count | if self.active { WDGA } else { 0 }),
            0x04 => Ok(self.cfr),
            0x08 => Ok(u32::from(self.early_wakeup)),
            _ => Err(Refusal::Offset),
        }
    }

    /// Writes a register. `Ok(true)`: the chip is reset (T6 written 0, or a refresh outside of the window).
    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Answer<bool> {
        self.sync(now);
        let mut resets = false;
        match offset {
            0x00 => {
                only(value, WDGA | TOP, "WWDG_CR reserved bits")?;
                let too_early = self.active && self.count > self.cfr & TOP;
                self.active |= value & WDGA != 0;
                self.count = value & TOP;
                resets = too_early || self.active && value & T6 == 0;
            }
            0x04 => {
                only(value, 0x3ff, "WWDG_CFR reserved bits")?;
                self.cfr = value | self.cfr & EWI; // only a reset clears EWI (21.6.2)
            }
            0x08 => self.early_wakeup &= value & 1 != 0,
            _ => return Err(Refusal::Offset),
        }
        self.schedule();
        Ok(resets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CR: u32 = 0;
    const CFR: u32 = 4;
    const SR: u32 = 8;

    /// Enabled with T and WDGTB when the prescaler is at zero, `divider` CPU cycles to a PCLK1 cycle.
    fn enabled(t: u32, wdgtb: u32, divider: u64) -> Wwdg {
        let mut wwdg = Wwdg::new();
        wwdg.set_clock(Some(divider), 0);
        assert_eq!(wwdg.write(CFR, wdgtb << 7 | TOP, 0), Ok(false));
        assert_eq!(wwdg.write(CR, WDGA | t, 0), Ok(false));
        wwdg
    }

    #[test]
    fn timeouts_are_those_of_the_manuals_table() {
        // RM0390 21.4, minimum and maximum at 30 MHz PCLK1, in microseconds; HCLK 120 MHz
        let table = [
            (0, 136.53, 8_738.0),
            (1, 273.07, 17_476.0),
            (2, 546.13, 34_953.0),
            (3, 1092.27, 69_905.0),
        ];
        for (wdgtb, min_us, max_us) in table {
            for (t, wanted_us) in [(0x40, min_us), (0x7f, max_us)] {
                let us = enabled(t, wdgtb, 4).due as f64 / 120.0;
                assert!((us / wanted_us - 1.0).abs() < 2e-4, "WDGTB {wdgtb}, T {t:#x}: {us} us");
            }
        }
    }

    #[test]
    fn the_reset_comes_when_t6_clears_and_not_before() {
        let mut wwdg = enabled(0x7f, 3, 4);
        let due = 4 * 4096 * 8 * 64; // t_PCLK1 * 4096 * 2^3 * (63 + 1)
        assert_eq!(wwdg.due, due);
        assert!(!wwdg.sync(due - 1));
        assert_eq!(wwdg.read(CR, due - 1), Ok(WDGA | 0x40));
        assert!(wwdg.sync(due));
    }

    #[test]
    fn a_refresh_reloads_the_counter_but_not_the_prescaler() {
        let mut wwdg = enabled(0x50, 0, 1);
        wwdg.write(CR, 0x50, 5 * 4096 + 4000).unwrap();
        assert_eq!(wwdg.due, (5 + 17) * 4096, "96 cycles into the first period are lost");
    }

    #[test]
    fn a_refresh_above_the_window_resets_and_one_inside_does_not() {
        let mut wwdg = enabled(0x7f, 0, 1);
        wwdg.write(CFR, 0x60, 0).unwrap();
        assert_eq!(wwdg.write(CR, 0x7f, 0x1f * 4096), Ok(false), "the counter is at 0x60");
        assert_eq!(wwdg.write(CR, 0x7f, (0x1f + 0x1e) * 4096), Ok(true), "at 0x61");
    }

    #[test]
    fn a_write_with_t6_clear_resets_at_once_when_enabled() {
        let mut wwdg = Wwdg::new();
        wwdg.set_clock(Some(1), 0);
        assert_eq!(wwdg.write(CR, 0x3f, 0), Ok(false), "not enabled");
        assert_eq!(wwdg.write(CR, WDGA | 0x3f, 0), Ok(true));
    }

    #[test]
    fn the_counter_runs_before_the_enable_and_enable_bits_cannot_be_cleared() {
        let mut wwdg = Wwdg::new();
        wwdg.set_clock(Some(2), 100);
        assert_eq!(wwdg.read(CR, 100 + 3 * 8192), Ok(0x7c), "free-running");
        wwdg.write(CFR, EWI | TOP, 100_000).unwrap();
        wwdg.write(CR, WDGA | 0x7f, 100_000).unwrap();
        wwdg.write(CFR, TOP, 100_000).unwrap();
        wwdg.write(CR, 0x7f, 100_000).unwrap();
        assert_eq!(wwdg.read(CFR, 100_000), Ok(EWI | TOP));
        assert_eq!(wwdg.read(CR, 100_000), Ok(WDGA | 0x7f));
    }

    #[test]
    fn the_early_wakeup_is_one_period_before_the_reset() {
        let mut wwdg = enabled(0x44, 1, 1);
        wwdg.write(CFR, EWI | 1 << 7 | TOP, 0).unwrap();
        assert_eq!(wwdg.due, 4 * 8192, "0x44 to 0x40");
        assert!(!wwdg.sync(wwdg.due));
        assert!(wwdg.request());
        assert_eq!(wwdg.due, 5 * 8192);
        wwdg.write(SR, 0, 4 * 8192 + 1).unwrap();
        assert!(!wwdg.request());
        assert_eq!(wwdg.read(SR, 4 * 8192 + 2), Ok(0));
    }

    #[test]
    fn the_counter_stops_without_its_clock() {
        let mut wwdg = enabled(0x7f, 0, 1);
        wwdg.set_clock(None, 10 * 4096 + 1);
        assert_eq!((wwdg.due, wwdg.is_running()), (u64::MAX, false));
        wwdg.set_clock(Some(4), 1_000_000_000);
        assert_eq!(
            wwdg.due,
            1_000_000_000 + 4 * (54 * 4096 - 1),
            "the remaining time, at a quarter of the rate"
        );
    }
}

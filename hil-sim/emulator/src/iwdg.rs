//! Independent watchdog (RM0390 chapter 20), clocked by the LSI of this chip.
use super::stop::{Answer, Refusal, only};

const KEY_UNLOCK: u32 = 0x5555;
const KEY_RELOAD: u32 = 0xaaaa;
const KEY_START: u32 = 0xcccc;
/// Time until a new prescaler or reload value is adopted, LSI cycles.
const UPDATE_LSI_CYCLES: u64 = 5;

#[derive(Default)]
pub(crate) struct Iwdg {
    lsi_hz: u32,
    unlocked: bool,
    running: bool,
    prescaler: u32,
    reload: u32,
    updating_until: [u64; 2],
    /// Cycles that were left when a debugger halted the core and DBGMCU stopped the counter.
    left_when_halted: Option<u64>,
    /// Cycle at which the counter reaches zero.
    pub due: u64,
}

impl Iwdg {
    pub fn new(lsi_hz: u32) -> Self {
        Self { lsi_hz, reload: 0xfff, due: u64::MAX, ..Self::default() }
    }

    /// Time-out in LSI cycles: (RL + 1) * 4 * 2^PR.
    fn timeout_lsi(&self) -> u64 {
        u64::from(self.reload + 1) << (2 + self.prescaler.min(6))
    }

    fn cycles(&self, lsi: u64, hclk_hz: u32) -> u64 {
        (u128::from(lsi) * u128::from(hclk_hz)).div_ceil(u128::from(self.lsi_hz)) as u64
    }

    /// Stops the counter while a debugger halts the core, or lets it continue.
    pub fn set_halted(&mut self, halted: bool, now: u64) {
        match (halted, self.left_when_halted.take()) {
            (true, None) if self.running => {
                self.left_when_halted = Some(self.due.saturating_sub(now));
                self.due = u64::MAX;
            }
            (true, left) => self.left_when_halted = left,
            (false, Some(left)) => self.due = now + left,
            (false, None) => {}
        }
    }

    /// Keeps the remaining time when the CPU clock, the unit of `due`, changes.
    pub fn rescale(&mut self, now: u64, old_hz: u32, new_hz: u32) {
        if self.running {
            let left = self.due.saturating_sub(now);
            self.due = now + (u128::from(left) * u128::from(new_hz) / u128::from(old_hz)) as u64;
        }
    }

    pub fn read(&self, offset: u32, now: u64) -> Answer<u32> {
        match offset {
            0x00 => Ok(0),
            0x04 => Ok(self.prescaler),
            0x08 => Ok(self.reload),
            0x0c => Ok(u32::from(now < self.updating_until[0])
                | u32::from(now < self.updating_until[1]) << 1),
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write(&mut self, offset: u32, value: u32, now: u64, hclk_hz: u32) -> Answer<()> {
        match (offset, value) {
            (0x00, KEY_UNLOCK) => self.unlocked = true,
            (0x00, KEY_RELOAD | KEY_START) => {
                self.unlocked = false;
                self.running |= value == KEY_START;
                if self.running {
                    self.due = now + self.cycles(self.timeout_lsi(), hclk_hz);
                }
            }
            (0x00, _) => self.unlocked = false,
            (0x04 | 0x08, _) if !self.unlocked => {} // write-protected: ignored
            (0x04, _) => {
                only(value, 7, "IWDG_PR reserved bits")?;
                self.prescaler = value;
                self.updating_until[0] = now + self.cycles(UPDATE_LSI_CYCLES, hclk_hz);
            }
            (0x08, _) => {
                only(value, 0xfff, "IWDG_RLR reserved bits")?;
                self.reload = value;
                self.updating_until[1] = now + self.cycles(UPDATE_LSI_CYCLES, hclk_hz);
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    const HCLK: u32 = 180_000_000;

    #[test]
    fn longest_timeout_is_that_of_the_manual() {
        let mut iwdg = Iwdg::new(crate::rcc::LSI_HZ);
        iwdg.write(0, KEY_UNLOCK, 0, HCLK).unwrap();
        iwdg.write(4, 6, 0, HCLK).unwrap();
        iwdg.write(0, KEY_START, 0, HCLK).unwrap();
        assert_eq!(
            iwdg.due,
            32_768 * u64::from(HCLK) / 1000,
            "32768 ms for PR = 6, RL = 0xfff (table of time-outs at 32 kHz)"
        );
    }

    /// DS10693: the LSI has 17 to 47 kHz.
    #[test]
    fn the_timeout_follows_the_oscillator() {
        for (lsi_hz, ms) in [(17_000, 188), (47_000, 68)] {
            let mut iwdg = Iwdg::new(lsi_hz);
            iwdg.write(0, KEY_UNLOCK, 0, HCLK).unwrap();
            iwdg.write(4, 3, 0, HCLK).unwrap();
            iwdg.write(8, 99, 0, HCLK).unwrap();
            iwdg.write(0, KEY_START, 0, HCLK).unwrap();
            assert_eq!(iwdg.due / (u64::from(HCLK) / 1000), ms, "{lsi_hz} Hz");
        }
    }

    #[test]
    fn a_halted_counter_keeps_the_time_that_is_left() {
        let mut iwdg = Iwdg::new(32_000);
        iwdg.write(0, KEY_START, 0, HCLK).unwrap();
        let due = iwdg.due;
        iwdg.set_halted(true, 1000);
        assert_eq!(iwdg.due, u64::MAX);
        iwdg.set_halted(false, 51_000);
        assert_eq!(iwdg.due, due + 50_000);
    }

    #[test]
    fn registers_need_the_key_and_a_reload_restarts_the_counter() {
        let mut iwdg = Iwdg::new(crate::rcc::LSI_HZ);
        iwdg.write(8, 31, 0, HCLK).unwrap();
        assert_eq!(iwdg.read(8, 0).unwrap(), 0xfff, "locked");
        iwdg.write(0, KEY_UNLOCK, 0, HCLK).unwrap();
        iwdg.write(8, 31, 0, HCLK).unwrap();
        assert_eq!(iwdg.read(0xc, 1).unwrap(), 2, "RVU");
        iwdg.write(0, KEY_RELOAD, 0, HCLK).unwrap();
        assert_eq!(iwdg.due, u64::MAX, "not started");
        iwdg.write(0, KEY_START, 0, HCLK).unwrap();
        assert_eq!(iwdg.due, 720_000, "32 * 4 / 32 kHz = 4 ms");
        iwdg.write(0, KEY_RELOAD, 500_000, HCLK).unwrap();
        assert_eq!(iwdg.due, 1_220_000);
        iwdg.rescale(500_000, HCLK, 16_000_000);
        assert_eq!(iwdg.due, 564_000, "4 ms at 16 MHz");
    }
}

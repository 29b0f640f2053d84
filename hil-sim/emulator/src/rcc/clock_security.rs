//! Failure of the external oscillator (RM0390 6.2.7, clock security system), and the reset flags.
use super::{Clocks, HSE, Rcc};
use crate::stop::Answer;
use thermal_sim::processor::ResetCause;

const HSEON: u32 = 1 << 16;
const CSSON: u32 = 1 << 19;
const PLLON: u32 = 1 << 24;
const PLL_BY_HSE: u32 = 1 << 22;

/// Source of the system clock after the external oscillator has stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterHse {
    /// As before.
    Unaffected,
    /// The internal oscillator, selected by the clock security system; holds the clocks before.
    Internal(Clocks),
    /// Nothing: no clock security system, and the system clock came from it.
    Nothing,
}

impl Rcc {
    /// The registers after a reset. Flags of earlier resets stay unless the supply was lost (6.3.21); an external clock
    /// that is absent stays absent.
    pub fn after_reset(&self, cause: ResetCause) -> Self {
        let flags = match cause {
            ResetCause::PowerOn | ResetCause::BrownOut => 0,
            _ => self.flags(),
        };
        Self {
            hse_failed: self.hse_failed,
            hse_start_us: self.hse_start_us,
            ..Self::new(cause, flags)
        }
    }

    /// The external clock comes, or comes back; the ready flag follows after the start-up time if HSEON is set.
    pub fn start_hse(&mut self, now: u64) {
        if self.hse_failed {
            self.hse_failed = false;
            self.ready_at[HSE] = self.after(now, self.hse_start_us);
        }
    }

    /// Stops the external oscillator.
    pub fn stop_hse(&mut self) -> Answer<AfterHse> {
        self.hse_failed = true;
        let pll = self.cr & PLLON != 0 && self.pllcfgr & PLL_BY_HSE != 0;
        let drives = match self.cfgr & 3 {
            0 => false,
            1 => true,
            _ => self.pllcfgr & PLL_BY_HSE != 0,
        };
        let detected = self.cr & (CSSON | HSEON) == CSSON | HSEON;
        if !detected {
            return Ok(if drives { AfterHse::Nothing } else { AfterHse::Unaffected });
        }
        self.clock_failure = true;
        self.cr &= !HSEON;
        if pll {
            self.cr &= !PLLON;
        }
        if !drives {
            return Ok(AfterHse::Unaffected);
        }
        let old = self.clocks;
        self.cr |= 1;
        self.cfgr &= !3;
        self.clocks = self.clocks_for(self.cfgr)?;
        Ok(AfterHse::Internal(old))
    }

    /// Request for the NMI: the clock security system has detected a failure, and software has not cleared CSSF.
    pub const fn clock_failure_interrupt(&self) -> bool {
        self.clock_failure
    }
}

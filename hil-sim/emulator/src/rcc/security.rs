//! What becomes of the clocks when the external oscillator fails (RM0390 6.2.7, clock security system), and of the
//! reset flags at a reset.
use super::{Clocks, Rcc};
use crate::stop::Answer;
use thermal_sim::processor::ResetCause;

const HSEON: u32 = 1 << 16;
const CSSON: u32 = 1 << 19;
const PLLON: u32 = 1 << 24;
const PLL_BY_HSE: u32 = 1 << 22;

/// What drives the chip after the external oscillator has stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterHse {
    /// What drove it before.
    Unaffected,
    /// The internal oscillator, to which the clock security system has switched; the clocks were these.
    Internal(Clocks),
    /// Nothing: no clock security, and the system clock came from it.
    Nothing,
}

impl Rcc {
    /// The registers after a reset. The flags of earlier resets stay, unless the supply was gone (6.3.21); an external
    /// oscillator that has failed stays so.
    pub fn after_reset(&self, cause: ResetCause) -> Self {
        let flags = match cause {
            ResetCause::PowerOn | ResetCause::BrownOut => 0,
            _ => self.flags(),
        };
        Self {
            hse_failed: self.hse_failed,
            ..Self::new(cause, flags)
        }
    }

    /// The external oscillator stops for good.
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
            return Ok(if drives {
                AfterHse::Nothing
            } else {
                AfterHse::Unaffected
            });
        }
        self.security = true;
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
        self.clocks = self.computed(self.cfgr)?;
        Ok(AfterHse::Internal(old))
    }

    /// The clock security system has seen the oscillator fail (CSSF): holds the NMI until software clears it.
    pub const fn security_interrupt(&self) -> bool {
        self.security
    }
}

//! Limits of the clock tree: the voltage regulator (RM0390 5.4) and the flash interface (3.8).
use super::{PLL, Rcc};
use crate::stop::{Answer, Refusal, only};

/// Time until over-drive, and the switch to it, is ready (of the order of DS10693 section 6.3.5).
const OVER_DRIVE_US: u64 = 45;

impl Rcc {
    /// PWR registers (5.4).
    pub fn read_pwr(&self, offset: u32, now: u64) -> Answer<u32> {
        match offset {
            0 => Ok(self.pwr_cr),
            4 => {
                let ready = |i: usize| u32::from(now >= self.over_drive_at[i]);
                let vos_ready = u32::from(self.is_ready(PLL, now));
                Ok(vos_ready << 14 | ready(0) << 16 | ready(1) << 17)
            }
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write_pwr(&mut self, offset: u32, value: u32, now: u64) -> Answer<()> {
        if offset != 0 {
            return Err(Refusal::Offset);
        }
        // DBP protects a domain that is not modelled; the clear bits act on wake-up flags that stay 0
        only(value, 0x0003_c10c, "PWR_CR beyond VOS, ODEN, ODSWEN and DBP")?;
        for (i, bit) in [(0, 16), (1, 17)] {
            if value >> bit & 1 == 0 {
                self.over_drive_at[i] = u64::MAX;
            } else if self.pwr_cr >> bit & 1 == 0 {
                if i == 1 && now < self.over_drive_at[0] {
                    return Err(Refusal::NotModelled("PWR_CR.ODSWEN before ODRDY"));
                }
                self.over_drive_at[i] = self.after(now, OVER_DRIVE_US);
            }
        }
        self.pwr_cr = value & !0xc;
        Ok(())
    }

    /// FLASH_ACR (3.8.1).
    pub fn acr(&self) -> u32 {
        self.acr
    }

    pub fn write_acr(&mut self, value: u32) -> Answer<()> {
        only(value, 0x1f0f, "FLASH_ACR")?;
        self.acr = value;
        self.check_latency()
    }
}

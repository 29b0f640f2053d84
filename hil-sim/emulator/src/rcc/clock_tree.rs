//! Oscillators, PLL and prescalers (RM0390 6.2, 6.3.1 to 6.3.3): the resulting frequencies, and whether the regulator and the
//! flash allow them.
use super::{Clocks, HSE, HSE_HZ, HSI, HSI_HZ, PLL, Rcc};
use crate::stop::{Answer, Refusal, only};

/// Start-up times in microseconds, of the order the data sheet (DS10693 section 6.3) gives as typical; that of the
/// external clock is the chip's.
const HSI_START_US: u64 = 2;
const PLL_LOCK_US: u64 = 100;

impl Rcc {
    pub(super) fn write_cr(&mut self, value: u32, now: u64) -> Answer<()> {
        let turned_on = value & !self.cr;
        for (bit, source, us) in
            [(0, HSI, HSI_START_US), (16, HSE, self.hse_start_us), (24, PLL, PLL_LOCK_US)]
        {
            if turned_on >> bit & 1 != 0 {
                self.ready_at[source] = self.after(now, us);
            }
        }
        let in_use = match self.cfgr & 3 {
            0 => 0x0000_0001,
            1 => 0x0001_0000,
            _ => 0x0100_0000 | if self.pllcfgr >> 22 & 1 != 0 { 0x0001_0000 } else { 1 },
        };
        if turned_on >> 24 & 1 != 0 {
            self.pll_hz()?;
            if self.pllcfgr >> 22 & 1 != 0 && !self.is_ready(HSE, now) {
                return Err(Refusal::NotModelled("RCC_CR.PLLON with HSE as source before HSERDY"));
            }
        }
        // hardware keeps a clock on that drives the system (6.3.1)
        self.cr = value & 0x010d_00f9 | self.cr & 0xff00 | in_use;
        Ok(())
    }

    /// PLL output for the system clock (6.3.2).
    fn pll_hz(&self) -> Answer<u32> {
        let (m, n) = (self.pllcfgr & 0x3f, self.pllcfgr >> 6 & 0x1ff);
        let p = 2 * ((self.pllcfgr >> 16 & 3) + 1);
        let source = if self.pllcfgr >> 22 & 1 != 0 { HSE_HZ } else { HSI_HZ };
        let input = source / m.max(1);
        within("PLL input", input, 950_000, 2_100_000)?;
        let vco = source as u64 * u64::from(n) / u64::from(m.max(1));
        within("PLL VCO", vco as u32, 100_000_000, 432_000_000)?;
        Ok((vco / u64::from(p)) as u32)
    }

    pub(super) fn write_cfgr(&mut self, value: u32, now: u64) -> Answer<()> {
        let source = (value & 3) as usize;
        if source == 3 {
            return Err(Refusal::NotModelled("RCC_CFGR.SW = PLL_R"));
        }
        if !self.is_ready([HSI, HSE, PLL][source], now) {
            return Err(Refusal::NotModelled("RCC_CFGR.SW = a source that is not ready"));
        }
        only(value, 0x001f_fcff, "RCC_CFGR clock outputs")?;
        self.clocks = self.clocks_for(value)?;
        self.cfgr = value & 0x001f_fcf3;
        self.check_latency()
    }

    pub(super) fn clocks_for(&self, cfgr: u32) -> Answer<Clocks> {
        let sysclk_hz = match cfgr & 3 {
            0 => HSI_HZ,
            1 => HSE_HZ,
            _ => self.pll_hz()?,
        };
        let hpre = cfgr >> 4 & 0xf;
        let hclk_hz = sysclk_hz
            >> match hpre {
                0..8 => 0,
                8..12 => hpre - 7,
                _ => hpre - 6,
            };
        let apb = |bits: u32| if bits & 4 == 0 { 0 } else { (bits & 3) + 1 };
        let (shift1, shift2) = (apb(cfgr >> 10 & 7), apb(cfgr >> 13 & 7));
        let (pclk1_hz, pclk2_hz) = (hclk_hz >> shift1, hclk_hz >> shift2);
        // 6.2: HCLK where the APB divides by 1 (TIMPRE: up to 4), else twice (four times) the APB clock
        let timer = |shift: u32| match self.dckcfgr >> 24 & 1 {
            0 => hclk_hz >> shift.saturating_sub(1),
            _ => hclk_hz >> shift.saturating_sub(2),
        };
        let over_drive = self.pwr_cr >> 17 & 1 != 0;
        let limit = match (self.pwr_cr >> 14 & 3, over_drive) {
            (3, true) => 180_000_000,
            (3, false) | (2, true) => 168_000_000,
            (2, false) => 144_000_000,
            _ => 120_000_000,
        };
        within("HCLK for the regulator's voltage scale and over-drive", hclk_hz, 1, limit)?;
        within("PCLK1", pclk1_hz, 1, 45_000_000)?;
        within("PCLK2", pclk2_hz, 1, 90_000_000)?;
        Ok(Clocks {
            sysclk_hz,
            hclk_hz,
            pclk1_hz,
            pclk2_hz,
            timclk1_hz: timer(shift1),
            timclk2_hz: timer(shift2),
        })
    }

    pub(super) fn check_latency(&self) -> Answer<()> {
        let needed = self.clocks.hclk_hz.div_ceil(30_000_000) - 1;
        let latency = self.acr & 0xf;
        if latency < needed {
            return Err(Refusal::FlashLatency { hclk_hz: self.clocks.hclk_hz, latency, needed });
        }
        Ok(())
    }
}

fn within(clock: &'static str, hz: u32, min_hz: u32, max_hz: u32) -> Answer<()> {
    if (min_hz..=max_hz).contains(&hz) {
        Ok(())
    } else {
        Err(Refusal::ClockRange { clock, hz, min_hz, max_hz })
    }
}

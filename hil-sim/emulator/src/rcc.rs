//! Reset and clock control (RM0390 chapter 6):
//! oscillators, PLL, bus prescalers, peripheral clock enables and resets, reset flags.
use super::stop::{Answer, Refusal, only};
use thermal_sim::processor::{ChipState, ResetCause};

mod clock_security;
mod clock_tree;
mod fresh_clocks;
mod power;

pub(crate) use clock_security::AfterHse;
use fresh_clocks::FreshClocks;

/// High-speed internal oscillator.
pub const HSI_HZ: u32 = 16_000_000;
/// High-speed external clock: that which the NUCLEO board's debug probe feeds into OSC_IN.
pub const HSE_HZ: u32 = 8_000_000;
/// Low-speed internal oscillator, nominal; a chip's own rate is [`ChipState::lsi_hz`](thermal_sim::processor::ChipState).
pub const LSI_HZ: u32 = 32_000;

/// Start-up time in microseconds, of the order the data sheet (DS10693 section 6.3) gives as typical.
const LSI_START_US: u64 = 20;

/// Frequencies in Hz as the RCC registers set them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Clocks {
    /// System clock before the AHB prescaler.
    pub sysclk_hz: u32,
    /// CPU, AHB and DMA clock; the machine's unit of time is one period of it.
    pub hclk_hz: u32,
    /// APB1 clock (USART2, TIM2 to TIM7 registers).
    pub pclk1_hz: u32,
    /// APB2 clock (ADC, TIM1 registers).
    pub pclk2_hz: u32,
    /// Counting clock of the timers on APB1.
    pub timclk1_hz: u32,
    /// Counting clock of the timers on APB2.
    pub timclk2_hz: u32,
}

/// RCC_CSR flags of a reset (6.3.21). Every internal reset also pulls NRST low, hence PINRSTF in all of them.
fn reset_flags(cause: ResetCause) -> u32 {
    match cause {
        ResetCause::PowerOn => 0x0e00_0000,
        ResetCause::Software => 0x1400_0000,
        ResetCause::IndependentWatchdog => 0x2400_0000,
        ResetCause::WindowWatchdog => 0x4400_0000,
        ResetCause::BrownOut => 0x0600_0000,
        ResetCause::Pin => 0x0400_0000,
    }
}

/// Bus enable register of a peripheral, by its place in [`ENR_NAMES`]; no modelled one is on AHB2 or AHB3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Enr {
    Ahb1,
    Apb1 = 3,
    Apb2 = 4,
}

const ENR_NAMES: [&str; 5] =
    ["RCC_AHB1ENR", "RCC_AHB2ENR", "RCC_AHB3ENR", "RCC_APB1ENR", "RCC_APB2ENR"];

/// Bits of the reset, enable and low-power enable registers that the chip has, in the order of [`ENR_NAMES`] (6.3.5 to 6.3.19).
const RESET_BITS: [u32; 5] = [0x2060_10ff, 0x81, 0x3, 0x3fff_c9ff, 0x00c7_7933];
const ENABLE_BITS: [u32; 5] = [0x6064_10ff, 0x81, 0x3, 0x3fff_c9ff, 0x00c7_7f33];
const LOW_POWER_BITS: [u32; 5] = [0x6067_90ff, 0x81, 0x3, 0x3fff_c9ff, 0x00c7_7f33];

#[derive(Default)]
pub(crate) struct Rcc {
    cr: u32,
    pllcfgr: u32,
    cfgr: u32,
    enr: [u32; 5],
    rstr: [u32; 5],
    lpenr: [u32; 5],
    csr: u32,
    dckcfgr: u32,
    /// Clocks that were enabled and do not run yet; up to date where instructions are noted, on a strict chip.
    fresh_clocks: FreshClocks,
    /// The external clock is not there.
    hse_failed: bool,
    /// Start-up time of the external clock, us.
    hse_start_us: u64,
    /// RCC_CIR.CSSF: the clock security system has detected the failure.
    clock_failure: bool,
    /// Cycle from which HSI, HSE, PLL and LSI are ready.
    ready_at: [u64; 4],
    /// PWR
    pwr_cr: u32,
    over_drive_at: [u64; 2],
    /// FLASH
    acr: u32,
    clocks: Clocks,
}

const HSI: usize = 0;
const HSE: usize = 1;
const PLL: usize = 2;
const LSI: usize = 3;

impl Rcc {
    pub fn new(cause: ResetCause, old_flags: u32) -> Self {
        let hsi = HSI_HZ;
        Self {
            cr: 0x81,
            pllcfgr: 0x2400_3010,
            enr: [0x0010_0000, 0, 0, 0, 0],
            lpenr: [0x7e67_91ff, 0xf1, 0x01, 0x36fe_c9ff, 0x0007_5f33],
            csr: reset_flags(cause) | old_flags & 0xfe00_0000,
            pwr_cr: 0xc000,
            hse_start_us: ChipState::default().external_clock_start_us.into(),
            over_drive_at: [u64::MAX; 2],
            clocks: Clocks {
                sysclk_hz: hsi,
                hclk_hz: hsi,
                pclk1_hz: hsi,
                pclk2_hz: hsi,
                timclk1_hz: hsi,
                timclk2_hz: hsi,
            },
            ..Self::default()
        }
    }

    /// The registers of a chip in this state at power-up.
    pub fn powered_up(chip: &ChipState) -> Self {
        Self {
            hse_failed: !chip.external_clock,
            hse_start_us: chip.external_clock_start_us.into(),
            ..Self::new(ResetCause::PowerOn, 0)
        }
    }

    pub fn clocks(&self) -> Clocks {
        self.clocks
    }

    /// Reset flags, which survive resets until RMVF clears them.
    pub fn flags(&self) -> u32 {
        self.csr & 0xfe00_0000
    }

    /// Whether a peripheral's clock runs; else the refusal that names the enable bit.
    #[inline]
    pub fn check_clock(&self, enr: Enr, bit: u8) -> Answer<()> {
        if self.enr[enr as usize] >> bit & 1 != 0 {
            Ok(())
        } else {
            Err(Refusal::ClockOff(ENR_NAMES[enr as usize], bit))
        }
    }

    /// Refuses an access to a peripheral whose clock was enabled too short a time ago.
    pub fn check_clock_runs(&self, enr: Enr, bit: u8) -> Answer<()> {
        if self.fresh_clocks.contains(enr as usize, bit) {
            return Err(Refusal::Misuse(
                "accessed right behind the enabling of its clock, without a DSB (ES0298, 2.2.7)",
            ));
        }
        Ok(())
    }

    /// Whether instructions must be [noted](Self::note_instruction).
    #[inline]
    pub fn has_fresh_clocks(&self) -> bool {
        !self.fresh_clocks.is_empty()
    }

    /// Takes note of an instruction before it runs.
    pub fn note_instruction(&mut self, is_dsb: bool) {
        self.fresh_clocks.note_instruction(is_dsb);
    }

    /// Whether a reset bit is held.
    pub fn in_reset(&self, enr: Enr, bit: u8) -> bool {
        self.rstr[enr as usize] >> bit & 1 != 0
    }

    fn after(&self, now: u64, us: u64) -> u64 {
        now + us * u64::from(self.clocks.hclk_hz) / 1_000_000
    }

    fn is_ready(&self, source: usize, now: u64) -> bool {
        let on = match source {
            HSI => self.cr & 1,
            HSE => self.cr >> 16 & 1 & u32::from(!self.hse_failed),
            PLL => self.cr >> 24 & 1,
            _ => self.csr & 1,
        };
        on != 0 && now >= self.ready_at[source]
    }

    pub fn read(&self, offset: u32, now: u64) -> Answer<u32> {
        let ready = |source: usize| u32::from(self.is_ready(source, now));
        Ok(match offset {
            0x00 => self.cr | ready(HSI) << 1 | ready(HSE) << 17 | ready(PLL) << 25,
            0x04 => self.pllcfgr,
            0x08 => self.cfgr | (self.cfgr & 3) << 2,
            // of the clock interrupts only that of the clock security system is modelled
            0x0c => u32::from(self.clock_failure) << 7,
            0x10..=0x6c => {
                let bus = Self::bus(offset)?;
                match offset >> 4 {
                    1 | 2 => self.rstr[bus],
                    3 | 4 => self.enr[bus],
                    _ => self.lpenr[bus],
                }
            }
            // backup domain, and clocks of peripherals that are not modelled: as at power-up
            0x70 | 0x94 => 0,
            0x74 => self.csr | ready(LSI) << 1,
            0x8c => self.dckcfgr,
            _ => return Err(Refusal::Offset),
        })
    }

    /// Instructions that must lie between the enabling of a clock and the first access to its peripheral (ES0298, 2.2.7).
    fn clock_delay(&self, bus: usize) -> u32 {
        let Clocks { hclk_hz, pclk1_hz, pclk2_hz, .. } = self.clocks;
        match bus {
            _ if bus == Enr::Apb1 as usize => 1 + hclk_hz / pclk1_hz,
            _ if bus == Enr::Apb2 as usize => 1 + hclk_hz / pclk2_hz,
            _ => 2,
        }
    }

    /// Bus of a reset or enable register: AHB1, AHB2, AHB3, gap, APB1, APB2, gap, gap, three times.
    fn bus(offset: u32) -> Answer<usize> {
        match (offset - 0x10) / 4 % 8 {
            bus @ 0..=2 => Ok(bus as usize),
            bus @ 4..=5 => Ok(bus as usize - 1),
            _ => Err(Refusal::Offset),
        }
    }

    /// Writes a register. `Ok(true)`: the clock tree changed.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Answer<bool> {
        match offset {
            0x00 => {
                only(value, 0x030f_ffff, "RCC_CR.PLLI2SON or PLLSAION")?;
                self.write_cr(value, now)?;
            }
            0x04 => {
                if self.cr >> 24 & 1 != 0 {
                    return Err(Refusal::NotModelled("RCC_PLLCFGR while the PLL is on"));
                }
                only(value, 0x7f43_7fff, "RCC_PLLCFGR reserved bits")?;
                self.pllcfgr = value;
            }
            0x08 => return self.write_cfgr(value, now).map(|()| true),
            0x0c => {
                only(value, 0x00ff_0000, "RCC_CIR interrupt enables")?;
                self.clock_failure &= value >> 23 & 1 == 0;
            }
            0x10..=0x6c => {
                let bus = Self::bus(offset)?;
                let (registers, allowed) = match offset >> 4 {
                    1 | 2 => (&mut self.rstr, RESET_BITS),
                    3 | 4 => (&mut self.enr, ENABLE_BITS),
                    _ => (&mut self.lpenr, LOW_POWER_BITS),
                };
                // reserved bits keep their reset value, which is not always 0
                only(value ^ registers[bus], allowed[bus], "reserved bits")?;
                let set = value & !std::mem::replace(&mut registers[bus], value);
                if matches!(offset >> 4, 3 | 4) {
                    self.fresh_clocks.add(bus, set, self.clock_delay(bus));
                }
            }
            0x70 => only(value, 0, "oscillator and clock of the RTC")?,
            0x94 => only(value, 0, "clocks of peripherals without a model")?,
            0x74 => {
                if value & 1 != 0 && self.csr & 1 == 0 {
                    self.ready_at[LSI] = self.after(now, LSI_START_US);
                }
                let flags = if value >> 24 & 1 != 0 { 0 } else { self.flags() };
                self.csr = flags | value & 1;
            }
            0x8c => {
                only(value, 1 << 24, "RCC_DCKCFGR audio clocks")?;
                self.dckcfgr = value;
                self.clocks = self.clocks_for(self.cfgr)?;
                return Ok(true);
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ready_at_180_mhz() -> Rcc {
        let mut rcc = Rcc::new(ResetCause::PowerOn, 0);
        rcc.write_acr(0x705).unwrap();
        rcc.write(0x00, 0x83 | 1 << 16 | 1 << 18, 0).unwrap();
        rcc.write(0x04, 0x2040_0000 | 8 | 360 << 6, 200).unwrap();
        rcc.write(0x00, 0x83 | 1 << 16 | 1 << 18 | 1 << 24, 200).unwrap();
        rcc.write_pwr(0, 0x1_c000, 200).unwrap();
        rcc.write_pwr(0, 0x3_c000, 2000).unwrap();
        rcc
    }

    #[test]
    fn ready_bits_follow_enables_after_the_start_up_time() {
        let rcc = ready_at_180_mhz();
        assert_eq!(rcc.read(0, 201).unwrap() >> 24 & 3, 1, "on, not locked");
        assert_eq!(rcc.read(0, 200 + 1600).unwrap() >> 24 & 3, 3, "100 us at 16 MHz later");
        assert_eq!(rcc.read_pwr(4, 2000).unwrap() >> 16 & 3, 1, "over-drive ready, not switched");
        assert_eq!(rcc.read_pwr(4, 3000).unwrap() >> 16 & 3, 3);
    }

    #[test]
    fn clock_tree_of_180_mhz() {
        let mut rcc = ready_at_180_mhz();
        assert_eq!(rcc.write(0x08, 2 | 5 << 10 | 4 << 13, 3000), Ok(true));
        let c = rcc.clocks();
        assert_eq!((c.sysclk_hz, c.hclk_hz), (180_000_000, 180_000_000));
        assert_eq!((c.pclk1_hz, c.pclk2_hz), (45_000_000, 90_000_000));
        assert_eq!((c.timclk1_hz, c.timclk2_hz), (90_000_000, 180_000_000));
        assert_eq!(rcc.read(0x08, 3000).unwrap() & 0xf, 0b1010, "SWS follows SW");
    }

    #[test]
    fn too_few_wait_states_are_refused() {
        let mut rcc = ready_at_180_mhz();
        rcc.write_acr(4).unwrap();
        let refusal = Refusal::FlashLatency { hclk_hz: 180_000_000, latency: 4, needed: 5 };
        assert_eq!(rcc.write(0x08, 2 | 5 << 10 | 4 << 13, 3000), Err(refusal));
    }

    #[test]
    fn buses_and_regulator_have_limits() {
        let mut rcc = ready_at_180_mhz();
        let too_fast =
            Refusal::ClockRange { clock: "PCLK1", hz: 90_000_000, min_hz: 1, max_hz: 45_000_000 };
        assert_eq!(rcc.write(0x08, 2 | 4 << 10 | 4 << 13, 3000), Err(too_fast));
        rcc.write_pwr(0, 0xc000, 3000).unwrap();
        assert!(matches!(
            rcc.write(0x08, 2 | 5 << 10 | 4 << 13, 3000),
            Err(Refusal::ClockRange { hz: 180_000_000, max_hz: 168_000_000, .. })
        ));
    }

    #[test]
    fn reset_flags_gather_until_cleared() {
        let mut rcc = Rcc::new(ResetCause::IndependentWatchdog, 0x0e00_0000);
        assert_eq!(rcc.read(0x74, 0).unwrap(), 0x2e00_0000);
        rcc.write(0x74, 1 << 24, 0).unwrap();
        assert_eq!(rcc.read(0x74, 0).unwrap(), 0);
    }
}

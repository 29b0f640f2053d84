//! The core's own registers on the private peripheral bus: SysTick, system control block, cycle counter, debug and
//! floating-point control (ARMv7-M Architecture Reference Manual B3, C1; Cortex-M4 TRM), DBGMCU (RM0390 33.16; which timers
//! and watchdogs stand still while a debugger halts the core is in `debug_freeze`).
use super::nvic::{Nvic, exception};
use super::stop::{Answer, Refusal, only};

/// Bits of CR, APB1_FZ and APB2_FZ (RM0390 33.16.3 to 33.16.5).
const DBGMCU_BITS: [u32; 3] = [0xe7, 0x07e0_1dff, 0x0007_0003];
/// CCR: frames without floating-point state begin at a multiple of 8, too.
const STKALIGN: u32 = 1 << 9;
/// DEMCR: a debugger halts the core at a reset, and at a hard fault.
const VC_CORERESET: u32 = 1;
const VC_HARDERR: u32 = 1 << 10;
/// DHCSR: a debugger is attached; the core's registers can be read.
const C_DEBUGEN: u32 = 1;
const S_REGRDY: u32 = 1 << 16;

#[derive(Default)]
pub(crate) struct Ppb {
    systick_csr: u32,
    systick_load: u32,
    /// Reload value of the present period.
    systick_from: u32,
    /// Cycle at which SysTick next reaches zero.
    pub systick_due: u64,
    /// SysTick's count while it stands still.
    systick_count: u32,
    pub vtor: u32,
    shcsr: u32,
    pub cfsr: u32,
    pub hfsr: u32,
    pub fault_address: u32,
    ccr: u32,
    cpacr: u32,
    fpccr: u32,
    demcr: u32,
    debugger_is_attached: bool,
    dwt_ctrl: u32,
    /// CYCCNT minus the counted cycles.
    cyccnt_offset: u32,
    /// Cycles asleep, which CYCCNT does not count.
    pub slept: u64,
    /// CR, APB1_FZ and APB2_FZ.
    pub dbgmcu: [u32; 3],
}

impl Ppb {
    pub fn new() -> Self {
        Self { systick_due: u64::MAX, ccr: STKALIGN, fpccr: 0xc000_0000, ..Self::default() }
    }

    /// Whether a configurable fault has its own handler enabled.
    pub fn fault_enabled(&self, exception: usize) -> bool {
        match exception {
            exception::MEM_MANAGE => self.shcsr >> 16 & 1 != 0,
            exception::BUS_FAULT => self.shcsr >> 17 & 1 != 0,
            exception::USAGE_FAULT => self.shcsr >> 18 & 1 != 0,
            _ => true,
        }
    }

    /// Whether CPACR grants access to the floating-point unit.
    #[inline]
    pub fn float_enabled(&self) -> bool {
        self.cpacr & 0xf0_0000 == 0xf0_0000
    }

    fn systick_step(&self) -> u64 {
        if self.systick_csr & 4 != 0 { 1 } else { 8 }
    }

    fn systick_period(&self) -> u64 {
        (u64::from(self.systick_load) + 1) * self.systick_step()
    }

    /// Handles the end of a SysTick period. `true`: its exception is enabled.
    pub fn systick_expire(&mut self) -> bool {
        self.systick_csr |= 1 << 16;
        self.systick_from = self.systick_load;
        self.systick_due = if self.systick_load == 0 {
            self.systick_count = 0;
            u64::MAX
        } else {
            self.systick_due + self.systick_period()
        };
        self.systick_csr & 2 != 0
    }

    fn systick_count(&self, now: u64) -> u32 {
        match self.systick_due {
            u64::MAX => self.systick_count,
            due => {
                ((due.saturating_sub(now) / self.systick_step())
                    % (u64::from(self.systick_from) + 1)) as u32
            }
        }
    }

    /// Goes on from `count`, or stands still there if it is off; from 0 the counter takes the reload value first.
    fn systick_continue(&mut self, count: u32, now: u64) {
        self.systick_count = count;
        self.systick_due = if self.systick_csr & 1 == 0 {
            u64::MAX
        } else if count > 0 {
            now + u64::from(count) * self.systick_step()
        } else {
            self.systick_from = self.systick_load;
            match self.systick_load {
                0 => u64::MAX,
                _ => now + self.systick_period(),
            }
        };
    }

    fn cyccnt(&self, now: u64) -> u32 {
        self.counted_cycles(now).wrapping_add(self.cyccnt_offset)
    }

    /// Cycles awake if CYCCNT counts, else 0.
    fn counted_cycles(&self, now: u64) -> u32 {
        if self.counts_cycles() { (now - self.slept) as u32 } else { 0 }
    }

    fn counts_cycles(&self) -> bool {
        self.dwt_ctrl & 1 != 0 && self.demcr >> 24 & 1 != 0
    }

    fn rebase_cyccnt(&mut self, value: u32, now: u64) {
        self.cyccnt_offset = value.wrapping_sub(self.counted_cycles(now));
    }

    /// Reads the register at an address of 0xE0000000..0xE00FFFFF; `ipsr` is the running exception.
    pub fn read(&mut self, nvic: &Nvic, address: u32, now: u64, ipsr: u32) -> Answer<u32> {
        Ok(match address {
            0xe000_1000 => 0x4000_0000 | self.dwt_ctrl,
            0xe000_1004 => self.cyccnt(now),
            0xe000_e004 => 3, // interrupt lines in groups of 32, minus one
            0xe000_e008 => 0,
            0xe000_e010 => {
                let csr = self.systick_csr;
                self.systick_csr &= !(1 << 16);
                csr
            }
            0xe000_e014 => self.systick_load,
            0xe000_e018 => self.systick_count(now),
            0xe000_e100..0xe000_e500 => return nvic.read(address - 0xe000_e000),
            0xe000_ed00 => 0x410f_c241,
            0xe000_ed04 => nvic.icsr(ipsr),
            0xe000_ed08 => self.vtor,
            0xe000_ed0c => 0xfa05_0000 | u32::from(nvic.group()) << 8,
            0xe000_ed10 => 0,
            0xe000_ed14 => self.ccr,
            0xe000_ed18..0xe000_ed24 => nvic.priority_word((address - 0xe000_ed18 + 4) as usize),
            0xe000_ed24 => self.shcsr | Self::active_bits(nvic),
            0xe000_ed28 => self.cfsr,
            0xe000_ed2c => self.hfsr,
            0xe000_ed34 | 0xe000_ed38 => self.fault_address,
            0xe000_ed88 => self.cpacr,
            0xe000_ed90 => 0x800, // MPU_TYPE: eight regions, which are not modelled
            0xe000_edf0 => match self.debugger_is_attached {
                true => C_DEBUGEN | S_REGRDY,
                false => 0,
            },
            0xe000_edfc => self.demcr,
            0xe000_ef34 => self.fpccr,
            0xe000_ef40 => 0x1011_0021,
            0xe000_ef44 => 0x1100_0011,
            0xe004_2000 => 0x1000_6421,
            0xe004_2004 | 0xe004_2008 | 0xe004_200c => {
                self.dbgmcu[(address as usize - 0xe004_2004) / 4]
            }
            _ => return Err(Refusal::Offset),
        })
    }

    fn active_bits(nvic: &Nvic) -> u32 {
        let bit = |n: usize, at: u32| u32::from(nvic.is_active(n)) << at;
        bit(4, 0) | bit(5, 1) | bit(6, 3) | bit(11, 7) | bit(12, 8) | bit(14, 10) | bit(15, 11)
    }

    /// Writes a register; `bytes` below 4 only where the manual has byte access (priorities). `Ok(true)`: AIRCR requests a
    /// system reset.
    pub fn write(
        &mut self,
        nvic: &mut Nvic,
        address: u32,
        bytes: u8,
        value: u32,
        now: u64,
    ) -> Answer<bool> {
        match address {
            0xe000_e100..0xe000_e500 => {
                nvic.write(address - 0xe000_e000, bytes, value, now)?;
            }
            0xe000_ed18..0xe000_ed24 => {
                for i in 0..u32::from(bytes) {
                    nvic.set_system_priority(
                        (address - 0xe000_ed18 + 4 + i) as usize,
                        (value >> (8 * i)) as u8,
                    );
                }
            }
            _ if bytes != 4 => return Err(Refusal::Width),
            0xe000_1000 => {
                only(value, 0x4000_0001, "DWT_CTRL beyond CYCCNTENA")?;
                let count = self.cyccnt(now);
                self.dwt_ctrl = value & 1;
                self.rebase_cyccnt(count, now);
            }
            0xe000_1004 => self.rebase_cyccnt(value, now),
            0xe000_1fb0 => {} // lock access: writes are always open on this core
            0xe000_e008 => only(value, 0, "ACTLR")?,
            0xe000_e010 => {
                let (was, count) = (self.systick_csr, self.systick_count(now));
                self.systick_csr = was & 1 << 16 | value & 7;
                if (was ^ value) & 5 != 0 {
                    self.systick_continue(count, now);
                }
            }
            0xe000_e014 => self.systick_load = value & 0xff_ffff,
            0xe000_e018 => {
                self.systick_csr &= !(1 << 16);
                self.systick_continue(0, now);
            }
            0xe000_ed04 => nvic.set_icsr(value, now),
            0xe000_ed08 => self.vtor = value & 0xffff_fe00,
            0xe000_ed0c => {
                if value >> 16 != 0x05fa {
                    return Ok(false); // without the key a write is ignored
                }
                only(value & 0xffff, 0x0704, "AIRCR.VECTCLRACTIVE, AIRCR.VECTRESET")?;
                nvic.set_group((value >> 8) as u8);
                return Ok(value & 4 != 0);
            }
            0xe000_ed10 => only(value, 0, "SCR (deep sleep, sleep on exit, SEVONPEND)")?,
            0xe000_ed14 => {
                only(value, STKALIGN, "CCR traps")?;
                self.ccr = value;
            }
            0xe000_ed24 => {
                only(value & !Self::active_bits(nvic), 0x7_0000, "SHCSR pending or active bits")?;
                self.shcsr = value & 0x7_0000;
            }
            0xe000_ed28 => self.cfsr &= !value,
            0xe000_ed2c => self.hfsr &= !value,
            0xe000_ed88 => {
                only(value, 0xf0_0000, "CPACR coprocessors other than the FPU")?;
                self.cpacr = value;
            }
            0xe000_edfc => {
                only(
                    value,
                    0x0100_0000 | VC_CORERESET | VC_HARDERR,
                    "DEMCR beyond TRCENA and the vector catch of resets and hard faults",
                )?;
                let count = self.cyccnt(now);
                self.demcr = value;
                self.rebase_cyccnt(count, now);
            }
            0xe000_ef00 => {
                only(value, 0x1ff, "STIR reserved bits")?;
                nvic.pend(16 + (value as usize).min(96), now);
            }
            0xe000_ef34 => {
                if value & 0xc000_0000 == 0x4000_0000 || value & 0x8000_0000 == 0 {
                    return Err(Refusal::NotModelled("FPCCR.ASPEN = 0 (no automatic FP state)"));
                }
                self.fpccr = value & 0xc000_0000;
            }
            0xe004_2004 | 0xe004_2008 | 0xe004_200c => {
                let register = (address as usize - 0xe004_2004) / 4;
                only(value, DBGMCU_BITS[register], "DBGMCU reserved bits")?;
                self.dbgmcu[register] = value;
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(false)
    }

    /// After a system reset: the cycles asleep go on, and only a power-on resets DBGMCU (33.16.3) and what a debugger has set.
    pub fn after_reset(&self, power_on: bool) -> Self {
        let fresh = Self { slept: self.slept, ..Self::new() };
        if power_on {
            return fresh;
        }
        Self {
            dbgmcu: self.dbgmcu,
            debugger_is_attached: self.debugger_is_attached,
            demcr: self.demcr & (VC_CORERESET | VC_HARDERR),
            ..fresh
        }
    }

    /// A debugger attaches, and catches resets and hard faults.
    pub fn attach_debugger(&mut self) {
        self.debugger_is_attached = true;
        self.demcr |= VC_CORERESET | VC_HARDERR;
    }

    pub fn debugger_is_attached(&self) -> bool {
        self.debugger_is_attached
    }

    pub fn catches_reset(&self) -> bool {
        self.debugger_is_attached && self.demcr & VC_CORERESET != 0
    }

    pub fn catches_hard_fault(&self) -> bool {
        self.debugger_is_attached && self.demcr & VC_HARDERR != 0
    }

    /// CCR.STKALIGN.
    pub fn aligns_stack(&self) -> bool {
        self.ccr & STKALIGN != 0
    }

    /// FPCCR.LSPEN: an exception's entry reserves the place of the floating-point state only.
    pub fn stacks_float_state_lazily(&self) -> bool {
        self.fpccr & 1 << 30 != 0
    }

    /// DBGMCU_CR.DBG_SLEEP keeps the core's clock, and with it CYCCNT, running in sleep.
    pub fn counts_asleep(&self) -> bool {
        self.dbgmcu[0] & 1 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systick_fires_every_load_plus_one_cycles() {
        let (mut ppb, mut nvic) = (Ppb::new(), Nvic::new());
        ppb.write(&mut nvic, 0xe000_e014, 4, 179_999, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e018, 4, 0, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e010, 4, 7, 1000).unwrap();
        assert_eq!(ppb.systick_due, 181_000);
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 1001, 0).unwrap(), 179_999);
        assert!(ppb.systick_expire());
        assert_eq!(ppb.systick_due, 361_000);
        assert_eq!(
            ppb.read(&nvic, 0xe000_e010, 181_001, 0).unwrap(),
            1 << 16 | 7,
            "COUNTFLAG, cleared by reading"
        );
        assert_eq!(ppb.read(&nvic, 0xe000_e010, 181_002, 0).unwrap(), 7);
    }

    /// ARMv7-M B3.3: the counter takes the reload value when it has reached zero.
    #[test]
    fn systick_adopts_a_new_reload_value_at_its_next_period() {
        let (mut ppb, mut nvic) = (Ppb::new(), Nvic::new());
        ppb.write(&mut nvic, 0xe000_e014, 4, 999, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e010, 4, 5, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e014, 4, 99, 300).unwrap();
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 400, 0).unwrap(), 600);
        assert_eq!(ppb.systick_due, 1000);
        ppb.systick_expire();
        assert_eq!(ppb.systick_due, 1100);
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 1001, 0).unwrap(), 99);
    }

    /// ARMv7-M B3.3: a counter that is enabled counts from the value in SYST_CVR, and a disabled one keeps it.
    #[test]
    fn a_stopped_systick_keeps_its_count_and_goes_on() {
        let (mut ppb, mut nvic) = (Ppb::new(), Nvic::new());
        ppb.write(&mut nvic, 0xe000_e014, 4, 999, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e010, 4, 5, 0).unwrap();
        ppb.write(&mut nvic, 0xe000_e010, 4, 4, 300).unwrap();
        assert_eq!(ppb.systick_due, u64::MAX);
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 5000, 0).unwrap(), 700);
        ppb.write(&mut nvic, 0xe000_e010, 4, 5, 6000).unwrap();
        assert_eq!(ppb.systick_due, 6700);
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 6100, 0).unwrap(), 600);
        ppb.write(&mut nvic, 0xe000_e010, 4, 4, 6200).unwrap();
        ppb.write(&mut nvic, 0xe000_e018, 4, 1, 6300).unwrap();
        assert_eq!(ppb.read(&nvic, 0xe000_e018, 6400, 0).unwrap(), 0);
        ppb.write(&mut nvic, 0xe000_e010, 4, 5, 7000).unwrap();
        assert_eq!(ppb.systick_due, 8000, "from 0 it takes the reload value");
    }

    #[test]
    fn cyccnt_needs_trace_enabled_and_does_not_count_sleep() {
        let (mut ppb, mut nvic) = (Ppb::new(), Nvic::new());
        ppb.write(&mut nvic, 0xe000_1000, 4, 1, 100).unwrap();
        assert_eq!(ppb.read(&nvic, 0xe000_1004, 500, 0).unwrap(), 0);
        ppb.write(&mut nvic, 0xe000_edfc, 4, 1 << 24, 500).unwrap();
        ppb.slept += 1000;
        assert_eq!(ppb.read(&nvic, 0xe000_1004, 1700, 0).unwrap(), 200);
        ppb.write(&mut nvic, 0xe000_1004, 4, 5, 1700).unwrap();
        assert_eq!(ppb.read(&nvic, 0xe000_1004, 1710, 0).unwrap(), 15);
    }

    #[test]
    fn unmodelled_control_bits_are_refused() {
        let (mut ppb, mut nvic) = (Ppb::new(), Nvic::new());
        assert!(ppb.write(&mut nvic, 0xe000_ed10, 4, 4, 0).is_err(), "SLEEPDEEP");
        assert!(ppb.write(&mut nvic, 0xe000_ed94, 4, 1, 0).is_err(), "MPU_CTRL");
        assert_eq!(ppb.write(&mut nvic, 0xe000_ed0c, 4, 0x05fa_0004, 0), Ok(true));
        assert_eq!(ppb.write(&mut nvic, 0xe000_ed0c, 4, 0x0000_0004, 0), Ok(false), "no key");
    }
}

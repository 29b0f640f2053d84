//! An attached debugger (ARMv7-M C1): breakpoints, hard faults and resets halt the core, and the debugger reads and changes
//! registers and memory of the halted core. Without a debugger a breakpoint is a hard fault.
use super::Wiring;
use super::elf::RAM_BASE;
use super::mcu::{Machine, emulator};
use super::state::get;
use super::stop::{Place, Stop};
use thermal_sim::processor::ResetCause;
use unicorn_engine::RegisterARM as Reg;

/// A Thumb BKPT; its number is in the low byte.
const BKPT: u16 = 0xbe00;
const BKPT_BYTES: u32 = 2;

/// Why the core is halted under a debugger.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Halted {
    /// A BKPT with this number; the PC is at it.
    Breakpoint(u8),
    /// The vector catch of hard faults.
    HardFault {
        /// What escalated to the hard fault.
        cause: &'static str,
        /// Where in the image.
        place: Place,
    },
    /// The vector catch of resets; the core is about to execute its first instruction.
    Reset(ResetCause),
}

impl<W: Wiring + 'static> Machine<W> {
    /// Resets the chip as a debugger does (SYSRESETREQ) and lets it run from its reset vector. From then on breakpoints, hard
    /// faults and resets halt the core.
    ///
    /// # Errors
    /// The image cannot be started.
    pub fn restart_under_debugger(&mut self) -> Result<(), Stop> {
        self.chip_mut().ppb.attach_debugger();
        self.system_reset(ResetCause::Software)?;
        self.debugger_event = None;
        self.continue_by_debugger();
        Ok(())
    }

    /// Runs to a time in picoseconds since power-up, or until the core halts.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn run_until_halted(&mut self, ps: u64) -> Result<Option<Halted>, Stop> {
        self.run_until_ps(ps)?;
        Ok(self.debugger_event.take())
    }

    /// Halts the core, which [`run_until_halted`](Self::run_until_halted) reports.
    pub(super) fn halt_under_debugger(&mut self, why: Halted) {
        self.halt_by_debugger();
        self.debugger_event = Some(why);
    }

    /// The BKPT at `pc`, where the core stands.
    pub(super) fn breakpoint(&self, pc: u32) -> Halted {
        let code = self.memory(pc, BKPT_BYTES as usize).unwrap_or_default();
        let code = code.first_chunk().map_or(BKPT, |c| u16::from_le_bytes(*c));
        Halted::Breakpoint(code as u8)
    }

    /// R0 and R1 of the halted core: number and parameter of a semihosting call.
    pub fn call_registers(&self) -> [u32; 2] {
        [get(&self.cpu, Reg::R0), get(&self.cpu, Reg::R1)]
    }

    /// Lets the core continue behind the BKPT at which it is halted, with this value in R0, or with R0 as it is.
    ///
    /// # Errors
    /// The CPU emulation failed.
    pub fn continue_behind_breakpoint(&mut self, r0: Option<u32>) -> Result<(), Stop> {
        let next = get(&self.cpu, Reg::PC) + BKPT_BYTES;
        self.cpu.reg_write(Reg::PC, u64::from(next | 1)).map_err(emulator)?;
        if let Some(value) = r0 {
            self.cpu.reg_write(Reg::R0, value.into()).map_err(emulator)?;
        }
        self.continue_by_debugger();
        Ok(())
    }

    /// Writes to the RAM of the halted core. `false`: no RAM is there.
    pub fn write_ram(&mut self, address: u32, bytes: &[u8]) -> bool {
        address >= RAM_BASE && self.cpu.mem_write(address.into(), bytes).is_ok()
    }
}

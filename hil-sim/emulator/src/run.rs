//! The run loop: CPU emulation between events, sleep and resets.
use super::corrections;
use super::cost::Last;
use super::debugger::Halted;
use super::elf::{FLASH_BASE, RAM_BASE};
use super::exceptions;
use super::faults::{INVALID_STATE, NO_COPROCESSOR, NO_MEMORY, UNDEFINED};
use super::mcu::{Machine, Reset, emulator};
use super::rcc::HSI_HZ;
use super::state::{self, Exit, Refused, get, service, takeable};
use super::stop::{Access, Place, Refusal, Stop};
use super::{Wiring, names};
use thermal_sim::processor::ResetCause;
use unicorn_engine::{RegisterARM as Reg, uc_error};

/// A system reset holds the chip for about 20 us (DS10693: NRST pulse).
const RESET_US: u64 = 20;

/// End of a run.
#[derive(Debug, Clone, Copy)]
pub(super) enum RunLimit {
    /// To a cycle since power-up.
    Cycle(u64),
    /// To a time since power-up, ps; the clock may change on the way.
    Ps(u64),
}

impl<W: Wiring + 'static> Machine<W> {
    pub(super) fn run(&mut self, until: RunLimit) -> Result<(), Stop> {
        let now = self.now();
        self.chip_mut().sample_inputs(now);
        loop {
            if self.debugger_event.is_some() {
                return Ok(());
            }
            let now = self.now();
            let state = self.cpu.get_data_mut();
            let cycle = match until {
                RunLimit::Cycle(cycle) => cycle,
                RunLimit::Ps(ps) => state.chip_ref().time.cycle_at(ps),
            };
            state.set_limit(cycle);
            service(&mut self.cpu, now);
            if let Some(cause) = self.chip_mut().reset {
                self.system_reset(cause)?;
                continue;
            }
            self.pending_errors()?;
            if now >= cycle {
                return Ok(());
            }
            if let Some(halt) = self.halt {
                self.wait_while_halted(cycle, halt);
                continue;
            }
            if let Some(exception) = takeable(&self.cpu) {
                let pc = get(&self.cpu, Reg::PC);
                self.enter(exception, pc)?;
            }
            if self.is_back_in_lockup() {
                let pc = get(&self.cpu, Reg::PC);
                self.fault(NO_MEMORY, pc)?;
                continue;
            }
            self.execute()?;
        }
    }

    /// Handles refused register accesses of the last block, and faults that hooks raised.
    fn pending_errors(&mut self) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        if let Some((address, refusal)) = state.chip().misuse.take() {
            let (access, pc) = (Access::Write(4), state.block_pc);
            let refused = Refused { refusal, address, access, value: 0, pc };
            return Err(self.refusal(refused));
        }
        let state = self.cpu.get_data_mut();
        if !std::mem::take(&mut state.pause_requested) {
            return Ok(());
        }
        corrections::correct(&mut self.cpu);
        let state = self.cpu.get_data_mut();
        if let Some(block) = state.to_watch.take() {
            corrections::watch_block(&mut self.cpu, block).map_err(emulator)?;
        }
        let state = self.cpu.get_data_mut();
        if let Some(refused) = state.refused.take() {
            return Err(self.refusal(refused));
        }
        if let Some(fault) = state.raised.take() {
            let pc = get(&self.cpu, Reg::PC);
            self.halt = None;
            return self.fault(fault, pc);
        }
        Ok(())
    }

    /// Runs the CPU until a hook or an error stops it.
    fn execute(&mut self) -> Result<(), Stop> {
        let pc = get(&self.cpu, Reg::PC);
        self.cpu.get_data_mut().exit = Exit::Unspecified;
        let result = self.cpu.emu_start(u64::from(pc) | 1, 0xffff_ffff, 0, 0);
        let pc = get(&self.cpu, Reg::PC);
        let arm_state = result.is_err() && get(&self.cpu, Reg::XPSR) & 1 << 24 == 0;
        let state = self.cpu.get_data_mut();
        match (state.exit, result) {
            (Exit::Unspecified, Err(_)) if arm_state => {
                state::refund(state, pc);
                self.fault(INVALID_STATE, pc)
            }
            (Exit::Requested, _) => Ok(()),
            (Exit::FloatDenied, _) => self.fault(NO_COPROCESSOR, pc),
            (Exit::Exception(number), _) => self.cpu_exception(number, pc),
            (Exit::Unspecified, Ok(())) => self.asleep_or_stuck(pc),
            (Exit::Unspecified, Err(uc_error::INSN_INVALID)) => {
                let after_block = pc.wrapping_sub(state.block_pc) >= u32::from(state.block.bytes);
                match state.block.last {
                    Last::Wfe if after_block => {
                        self.wait_for_event();
                        Ok(())
                    }
                    Last::Yield if after_block => Ok(()),
                    _ => {
                        state::refund(state, pc);
                        self.fault(UNDEFINED, pc)
                    }
                }
            }
            (Exit::Unspecified, Err(uc_error::EXCEPTION)) => {
                state::refund(state, pc);
                self.fault(INVALID_STATE, pc)
            }
            (Exit::Unspecified, Err(error)) => match state.invalid.take() {
                Some((address, value, to_flash)) => {
                    state::refund(state, pc);
                    self.access_fault(error, address, value, to_flash, pc)
                }
                None => Err(emulator(error)),
            },
        }
    }

    fn asleep_or_stuck(&mut self, pc: u32) -> Result<(), Stop> {
        if self.cpu.get_data().block.last != Last::Wfi {
            return Err(Stop::Emulator(format!(
                "the CPU halted at {pc:#010x} without a sleep instruction"
            )));
        }
        self.enter_sleep();
        Ok(())
    }

    pub(super) fn system_reset(&mut self, cause: ResetCause) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        state.profile.end_all();
        let at = state.cycles;
        let held = RESET_US * u64::from(HSI_HZ) / 1_000_000;
        state.chip().system_reset(cause, at);
        let at_ps = state.chip().time.ps_at(at);
        state.cycles += held;
        if cause == ResetCause::PowerOn {
            self.restore_initial_ram()?;
        }
        let state = self.cpu.get_data_mut();
        (state.pause_requested, state.event_register) = (false, false);
        (state.refused, state.raised) = (None, None);
        (state.correction, state.to_watch) = (None, None);
        self.halt = None;
        self.resets.push(Reset { at, at_ps, cause });
        exceptions::reset(&mut self.cpu).map_err(|e| Stop::Emulator(format!("{e:?}")))?;
        if self.chip().ppb.catches_reset() {
            self.halt_under_debugger(Halted::Reset(cause));
        }
        Ok(())
    }

    pub(super) fn place(&self, pc: u32) -> Place {
        let in_flash = if pc < RAM_BASE { FLASH_BASE | pc } else { pc };
        Place { function: self.firmware.function_at(in_flash).to_owned(), pc: in_flash }
    }

    pub(super) fn refusal(&self, refused: Refused) -> Stop {
        let Refused { refusal, address, access, value, pc } = refused;
        let place = self.place(pc);
        let register = match refusal {
            Refusal::NotModelled(detail) => format!("{} ({detail})", names::register(address)),
            Refusal::Width => format!("{} (access width)", names::register(address)),
            _ => names::register(address),
        };
        match refusal {
            Refusal::ClockOff(enable, bit) => Stop::ClockOff {
                peripheral: names::peripheral(address).unwrap_or("?").to_owned(),
                enable: format!("{enable} bit {bit}"),
                address,
                access,
                place,
            },
            Refusal::FlashLatency { hclk_hz, latency, needed } => {
                Stop::FlashLatency { hclk_hz, latency, needed, place }
            }
            Refusal::Misuse(rule) => Stop::Misuse { register, address, rule, place },
            Refusal::ClockRange { clock, hz, min_hz, max_hz } => {
                Stop::ClockRange { clock, hz, min_hz, max_hz, place }
            }
            _ => Stop::NotModelled { register, address, access, value, place },
        }
    }
}

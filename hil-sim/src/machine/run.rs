//! The run loop: CPU emulation between events, sleep and resets.
use super::cost::Last;
use super::elf::{FLASH_BASE, RAM_BASE};
use super::exceptions;
use super::faults::{Fault, INVALID_STATE, NO_COPROCESSOR, UNDEFINED};
use super::mcu::{Machine, Reset, emulator};
use super::nvic::exception;
use super::rcc::{HSI_HZ, ResetCause};
use super::state::{self, Event, Refused, get, masks, service, takeable, with_chip};
use super::stop::{Place, Refusal, Stop};
use super::{Wiring, names};
use unicorn_engine::{RegisterARM as Reg, uc_error};

/// A system reset holds the chip for about 20 us (DS10693: NRST pulse).
const RESET_US: u64 = 20;

/// How the CPU sleeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sleep {
    /// Priority that a pending exception must beat to wake the CPU (PRIMASK does not count).
    threshold: i32,
}

impl<W: Wiring + 'static> Machine<W> {
    pub(super) fn run(&mut self, cycle: u64) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        state.limit = cycle;
        let now = state.cycles;
        state.chip().sample_inputs(now);
        loop {
            let now = self.now();
            service(&mut self.cpu, now);
            if let Some(cause) = self.cpu.get_data_mut().chip().reset {
                self.system_reset(cause)?;
                continue;
            }
            self.pending_errors()?;
            if now >= cycle {
                return Ok(());
            }
            if let Some(sleep) = self.sleep {
                self.sleep_until(cycle, sleep);
                continue;
            }
            if let Some(exception) = takeable(&self.cpu) {
                let pc = get(&self.cpu, Reg::PC);
                self.enter(exception, pc)?;
            }
            self.execute()?;
        }
    }

    /// Register accesses that ended the last block badly.
    fn pending_errors(&mut self) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        if !std::mem::take(&mut state.attention) {
            return Ok(());
        }
        if let Some(refused) = state.refused.take() {
            return Err(self.refusal(refused));
        }
        if state.bus_error.take().is_some() {
            let pc = get(&self.cpu, Reg::PC);
            let imprecise = 1 << 10;
            let fault = Fault {
                exception: exception::BUS_FAULT,
                status: imprecise,
                address: None,
                cause: "access to a reserved peripheral address",
            };
            self.sleep = None;
            return self.fault(fault, pc);
        }
        Ok(())
    }

    /// Lets the CPU run until something needs the loop.
    fn execute(&mut self) -> Result<(), Stop> {
        let pc = get(&self.cpu, Reg::PC);
        self.cpu.get_data_mut().event = Event::None;
        let result = self.cpu.emu_start(u64::from(pc) | 1, 0xffff_ffff, 0, 0);
        let pc = get(&self.cpu, Reg::PC);
        let state = self.cpu.get_data_mut();
        match (state.event, result) {
            (Event::Pause, _) => Ok(()),
            (Event::FloatDenied, _) => self.fault(NO_COPROCESSOR, pc),
            (Event::Raised(number), _) => self.raised(number, pc),
            (Event::None, Ok(())) => self.asleep_or_stuck(pc),
            (Event::None, Err(uc_error::INSN_INVALID)) => {
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
            (Event::None, Err(uc_error::EXCEPTION)) => {
                state::refund(state, pc);
                self.fault(INVALID_STATE, pc)
            }
            (Event::None, Err(error)) => match state.invalid.take() {
                Some((address, value, to_flash)) => {
                    state::refund(state, pc);
                    self.bad_access(error, address, value, to_flash, pc)
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
        self.fall_asleep();
        Ok(())
    }

    fn fall_asleep(&mut self) {
        let (_, basepri, faultmask) = masks(&self.cpu);
        let threshold = self
            .cpu
            .get_data()
            .chip_ref()
            .nvic
            .execution_priority(0, basepri, faultmask);
        self.sleep = Some(Sleep { threshold });
    }

    fn wait_for_event(&mut self) {
        if !std::mem::take(&mut self.cpu.get_data_mut().event_register) {
            self.fall_asleep();
        }
    }

    /// Passes time asleep until an exception wakes the CPU, a reset, or `limit`.
    fn sleep_until(&mut self, limit: u64, sleep: Sleep) {
        let start = self.now();
        let end = with_chip(&mut self.cpu, |chip, service| {
            let mut now = start;
            loop {
                let woken = chip
                    .nvic
                    .best()
                    .is_some_and(|(_, priority)| priority < sleep.threshold);
                if woken || chip.reset.is_some() || now >= limit {
                    chip.count_sleep(now - start);
                    return (now, woken);
                }
                now = chip.next.clamp(now, limit);
                service(chip, now);
            }
        });
        if let Some((now, woken)) = end {
            self.cpu.get_data_mut().cycles = now;
            if woken {
                self.sleep = None;
            }
        }
    }

    fn system_reset(&mut self, cause: ResetCause) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        state.profile.abandon();
        let at = state.cycles;
        let held = RESET_US * u64::from(HSI_HZ) / 1_000_000;
        state.chip().system_reset(cause, at);
        state.cycles += held;
        if cause == ResetCause::PowerOn {
            self.lose_memory()?;
        }
        let state = self.cpu.get_data_mut();
        (
            state.attention,
            state.refused,
            state.bus_error,
            state.event_register,
        ) = (false, None, None, false);
        self.sleep = None;
        self.resets.push(Reset { at, cause });
        exceptions::reset(&mut self.cpu).map_err(|e| Stop::Emulator(format!("{e:?}")))
    }

    pub(super) fn place(&self, pc: u32) -> Place {
        let in_flash = if pc < RAM_BASE { FLASH_BASE | pc } else { pc };
        Place {
            function: self.firmware.function_at(in_flash).to_owned(),
            pc: in_flash,
        }
    }

    fn refusal(&self, refused: Refused) -> Stop {
        let Refused {
            refusal,
            address,
            access,
            value,
            pc,
        } = refused;
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
            Refusal::FlashLatency {
                hclk_hz,
                latency,
                needed,
            } => Stop::FlashLatency {
                hclk_hz,
                latency,
                needed,
                place,
            },
            Refusal::ClockRange {
                clock,
                hz,
                min_hz,
                max_hz,
            } => Stop::ClockRange {
                clock,
                hz,
                min_hz,
                max_hz,
                place,
            },
            _ => Stop::NotModelled {
                register,
                address,
                access,
                value,
                place,
            },
        }
    }
}

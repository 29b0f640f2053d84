//! The run loop: CPU emulation between events, exceptions, faults, sleep and resets.
use super::chip::Chip;
use super::cost::Last;
use super::elf::{FLASH_BASE, Firmware, RAM_BASE, RAM_SIZE};
use super::exceptions::{self, FrameError};
use super::nvic::exception;
use super::profile::Stats;
use super::rcc::{Clocks, ResetCause};
use super::state::{self, Cpu, Event, Refused, State, get, masks, service, takeable, with_chip};
use super::stop::{Access, Place, Refusal, Stop};
use super::{LegState, Wiring, names};
use std::sync::Arc;
use unicorn_engine::{
    Arch, ArmCpuModel, HookType, MemType, Mode, Prot, RegisterARM as Reg, Unicorn, uc_error,
};

/// Byte that fills the RAM at power-up.
const PAINT: u8 = 0xc5;
/// A system reset holds the chip for about 20 us (DS10693: NRST pulse).
const RESET_US: u64 = 20;

/// A reset that happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reset {
    /// Cycles since power-up.
    pub at: u64,
    /// What caused it.
    pub cause: ResetCause,
}

/// How the CPU sleeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Sleep {
    /// Priority that a pending exception must beat to wake the CPU (PRIMASK does not count).
    threshold: i32,
}

/// A fault as the core reports it.
#[derive(Debug, Clone, Copy)]
struct Fault {
    exception: usize,
    /// Bits for CFSR.
    status: u32,
    address: Option<u32>,
    cause: &'static str,
}

const fn usage(status: u32, cause: &'static str) -> Fault {
    Fault {
        exception: exception::USAGE_FAULT,
        status,
        address: None,
        cause,
    }
}

const UNDEFINED: Fault = usage(1 << 16, "undefined instruction");
const INVALID_STATE: Fault = usage(1 << 17, "branch to an ARM address");
const INVALID_RETURN: Fault = usage(1 << 18, "invalid exception return");
const NO_COPROCESSOR: Fault = usage(1 << 19, "floating-point instruction while CPACR denies it");
const UNALIGNED: Fault = usage(1 << 24, "unaligned access");

/// An emulated STM32F446RE with an image in its flash.
pub struct Machine<W: Wiring + 'static> {
    cpu: Cpu<'static, W>,
    firmware: Firmware,
    sleep: Option<Sleep>,
    resets: Vec<Reset>,
    stopped: Option<Stop>,
}

impl<W: Wiring + 'static> Machine<W> {
    /// Powers the chip up with `firmware` in flash and `wiring` at its pins; nothing has run yet.
    ///
    /// # Errors
    /// [`Stop::Emulator`] when the CPU emulation cannot be set up.
    pub fn new(firmware: &Firmware, wiring: W) -> Result<Self, Stop> {
        let flash: Arc<[u8]> = firmware.flash().into();
        let state = State::new(Chip::new(wiring), Arc::clone(&flash));
        let cpu = set_up(state, &flash).map_err(emulator)?;
        let mut machine = Self {
            cpu,
            firmware: firmware.clone(),
            sleep: None,
            resets: Vec::new(),
            stopped: None,
        };
        exceptions::reset(&mut machine.cpu).map_err(|e| Stop::Emulator(format!("{e:?}")))?;
        machine.resets.push(Reset {
            at: 0,
            cause: ResetCause::PowerOn,
        });
        Ok(machine)
    }

    /// Runs until `cycle` (to the end of the basic block that reaches it), with every device event up to there.
    ///
    /// # Errors
    /// The reason why the run cannot go on; the same again on every later call.
    pub fn run_until(&mut self, cycle: u64) -> Result<(), Stop> {
        if let Some(stop) = &self.stopped {
            return Err(stop.clone());
        }
        let result = self.run(cycle);
        if let Err(stop) = &result {
            self.stopped = Some(stop.clone());
        }
        result
    }

    /// CPU cycles since power-up.
    pub fn now(&self) -> u64 {
        self.cpu.get_data().cycles
    }

    /// The clock tree as the image has set it.
    pub fn clocks(&self) -> Clocks {
        self.cpu.get_data().chip_ref().clocks()
    }

    /// What is at the pins.
    pub fn wiring(&self) -> &W {
        &self.cpu.get_data().chip_ref().wiring
    }

    /// What is at the pins, to be changed between two calls of [`run_until`](Self::run_until).
    pub fn wiring_mut(&mut self) -> &mut W {
        &mut self.cpu.get_data_mut().chip().wiring
    }

    /// The host starts to send `bytes` on USART2 now, or right after what it is still sending.
    pub fn uart_send(&mut self, bytes: &[u8]) {
        let now = self.now();
        let chip = self.cpu.get_data_mut().chip();
        chip.usart_mut().send(bytes, now);
        chip.refresh_next(now);
    }

    /// Bytes that the host has not finished sending.
    pub fn uart_sending(&self) -> usize {
        self.cpu.get_data().chip_ref().usart().sending()
    }

    /// Bit rate of the host, both ways; 1 Mbit/s at the start.
    pub fn set_host_baud(&mut self, baud: u32) {
        self.cpu.get_data_mut().chip().usart_mut().set_host_baud(baud);
    }

    /// State of the bridge leg on TIM1 `channel` (1 or 2); other channels drive nothing.
    pub fn leg_duty(&mut self, channel: usize) -> LegState {
        let now = self.now();
        let legs = self.cpu.get_data_mut().chip().legs(now);
        channel
            .checked_sub(1)
            .and_then(|i| legs.get(i))
            .copied()
            .unwrap_or(LegState::Off)
    }

    /// Level that a general-purpose output drives (port 0 is A); `None` when the pin is no driven output.
    pub fn gpio_output(&self, port: u8, bit: u8) -> Option<bool> {
        self.cpu.get_data().chip_ref().output(port, bit)
    }

    /// Counts since power-up.
    pub fn stats(&self) -> Stats {
        let state = self.cpu.get_data();
        Stats {
            instructions: state.instructions,
            cycles: state.cycles,
            exceptions: state.exceptions,
            sleep_share: state.chip_ref().slept as f64 / state.cycles.max(1) as f64,
            interrupts: state.profile.interrupts(),
        }
    }

    /// Resets since power-up, the power-up itself first.
    pub fn resets(&self) -> &[Reset] {
        &self.resets
    }

    /// Deepest use of the main stack since power-up, bytes; the RAM was painted then. `None` when the image has no
    /// symbol that tells where its static data end (`__sheap`, `__euninit` or `__ebss`).
    pub fn stack_high_water(&self) -> Option<u32> {
        let bottom = ["__sheap", "__euninit", "__ebss"]
            .iter()
            .find_map(|name| self.firmware.symbol(name))?;
        let top = self.firmware.initial_sp();
        let size = top.checked_sub(bottom)? as usize;
        let stack = self.cpu.mem_read_as_vec(u64::from(bottom), size).ok()?;
        let untouched = stack.iter().take_while(|b| **b == PAINT).count();
        Some((size - untouched) as u32)
    }

    /// Contents of RAM or flash, for tests and probes.
    pub fn memory(&self, address: u32, bytes: usize) -> Option<Vec<u8>> {
        self.cpu.mem_read_as_vec(u64::from(address), bytes).ok()
    }

    fn run(&mut self, cycle: u64) -> Result<(), Stop> {
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
            if now >= cycle {
                return Ok(());
            }
            if let Some(sleep) = self.sleep {
                self.sleep_until(cycle, sleep);
                continue;
            }
            self.pending_errors()?;
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
        state.attention = false;
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

    /// An exception that the CPU emulation raised by itself.
    fn raised(&mut self, number: u32, pc: u32) -> Result<(), Stop> {
        match number {
            2 => self.supervisor_call(pc),
            7 => {
                // no debugger is attached and the debug monitor is off (C1.5): a HardFault with DEBUGEVT
                self.cpu.get_data_mut().chip().ppb.hfsr |= 1 << 31;
                let fault = Fault {
                    exception: exception::HARD_FAULT,
                    status: 0,
                    address: None,
                    cause: "BKPT",
                };
                self.fault(fault, pc)
            }
            8 => match exceptions::leave(&mut self.cpu, pc | 1) {
                Err(FrameError::Return(_)) => self.fault(INVALID_RETURN, pc),
                other => self.framed(other, "unstacking"),
            },
            17 => self.fault(NO_COPROCESSOR, pc),
            18 => self.fault(INVALID_STATE, pc),
            22 => self.fault(UNALIGNED, pc),
            _ => Err(Stop::Emulator(format!(
                "exception {number} of the CPU emulation at {pc:#010x}"
            ))),
        }
    }

    /// SVC: taken at once, or a HardFault when its priority does not allow it (B1.5.4).
    fn supervisor_call(&mut self, pc: u32) -> Result<(), Stop> {
        let (primask, basepri, faultmask) = masks(&self.cpu);
        let state = self.cpu.get_data_mut();
        let now = state.cycles;
        let nvic = &mut state.chip().nvic;
        let level = nvic.execution_priority(primask, basepri, faultmask);
        if nvic.priority_of(exception::SVCALL) < level {
            nvic.pend(exception::SVCALL, now);
            return self.enter(exception::SVCALL, pc);
        }
        let cause = "SVC at or above its own priority";
        self.fault(
            Fault {
                exception: exception::HARD_FAULT,
                status: 0,
                address: None,
                cause,
            },
            pc,
        )
    }

    /// An access that no memory answered, as the CPU emulation reports it.
    fn bad_access(
        &mut self,
        error: uc_error,
        address: u32,
        value: u32,
        to_flash: bool,
        pc: u32,
    ) -> Result<(), Stop> {
        if to_flash {
            return Err(Stop::NotModelled {
                register: "flash programming".into(),
                address,
                access: Access::Write(4),
                value,
                place: self.place(pc),
            });
        }
        let fetch = matches!(error, uc_error::FETCH_UNMAPPED | uc_error::FETCH_PROT);
        let (status, cause) = match error {
            uc_error::FETCH_UNMAPPED | uc_error::FETCH_PROT => {
                (1 << 8, "instruction fetch where no memory is")
            }
            uc_error::READ_UNMAPPED | uc_error::READ_PROT => (1 << 9 | 1 << 15, "load where no memory is"),
            _ => (1 << 9 | 1 << 15, "store where no memory is"),
        };
        let address = (!fetch).then_some(address);
        self.fault(
            Fault {
                exception: exception::BUS_FAULT,
                status,
                address,
                cause,
            },
            pc,
        )
    }

    /// Takes a fault: its own handler if enabled and urgent enough, else HardFault, else lockup.
    fn fault(&mut self, fault: Fault, pc: u32) -> Result<(), Stop> {
        let (primask, basepri, faultmask) = masks(&self.cpu);
        let state = self.cpu.get_data_mut();
        let now = state.cycles;
        let chip = state.chip();
        let level = chip.nvic.execution_priority(primask, basepri, faultmask);
        chip.ppb.cfsr |= fault.status;
        if let Some(address) = fault.address {
            chip.ppb.fault_address = address;
        }
        let own = chip.ppb.fault_enabled(fault.exception) && chip.nvic.priority_of(fault.exception) < level;
        let taken = if own {
            fault.exception
        } else {
            exception::HARD_FAULT
        };
        if taken != fault.exception {
            chip.ppb.hfsr |= 1 << 30;
        }
        if chip.nvic.priority_of(taken) >= level {
            return Err(Stop::Lockup {
                cause: fault.cause.into(),
                priority: level,
                place: self.place(pc),
            });
        }
        chip.nvic.pend(taken, now);
        self.enter(taken, pc)
    }

    fn enter(&mut self, exception: usize, pc: u32) -> Result<(), Stop> {
        let result = exceptions::enter(&mut self.cpu, exception, pc);
        self.framed(result, "stacking")
    }

    /// A frame that does not fit into memory: silicon derives a fault whose handler has no stack either.
    fn framed(&mut self, result: Result<(), FrameError>, what: &str) -> Result<(), Stop> {
        match result {
            Ok(()) => Ok(()),
            Err(FrameError::Stack(address)) => Err(Stop::Lockup {
                cause: format!("exception {what} at {address:#010x}, where no memory is"),
                priority: self.cpu.get_data().chip_ref().nvic.active_priority(),
                place: self.place(self.cpu.get_data().block_pc),
            }),
            Err(error) => Err(Stop::Emulator(format!("{error:?} while {what}"))),
        }
    }

    fn system_reset(&mut self, cause: ResetCause) -> Result<(), Stop> {
        let state = self.cpu.get_data_mut();
        state.profile.abandon();
        let at = state.cycles;
        let held = RESET_US * u64::from(super::HSI_HZ) / 1_000_000;
        state.chip().system_reset(cause, at);
        state.cycles += held;
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

    fn place(&self, pc: u32) -> Place {
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

fn emulator(error: uc_error) -> Stop {
    Stop::Emulator(format!("{error:?}"))
}

/// Maps the memories and installs the hooks.
fn set_up<W: Wiring + 'static>(state: State<W>, flash: &[u8]) -> Result<Cpu<'static, W>, uc_error> {
    let mut cpu = Unicorn::new_with_data(Arch::ARM, Mode::THUMB | Mode::MCLASS, state)?;
    cpu.ctl_set_cpu_model(ArmCpuModel::CORTEX_M4 as i32)?;
    // BOOT0 is low: the flash also appears at 0 (RM0390 2.4)
    for base in [0, FLASH_BASE] {
        cpu.mem_map(u64::from(base), flash.len() as u64, Prot::READ | Prot::EXEC)?;
        cpu.mem_write(u64::from(base), flash)?;
    }
    cpu.mem_map(u64::from(RAM_BASE), u64::from(RAM_SIZE), Prot::ALL)?;
    cpu.mem_write(u64::from(RAM_BASE), &[PAINT; RAM_SIZE as usize])?;
    for (base, size) in [
        (0x4000_0000u64, 0x8_0000u64),
        (0x4200_0000, 0x100_0000),
        (0x5000_0000, 0x6_1000),
        (0xe000_0000, 0x10_0000),
    ] {
        cpu.mmio_map(
            base,
            size,
            Some(
                move |cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize| {
                    u64::from(state::on_read(cpu, (base + offset) as u32, bytes as u8))
                },
            ),
            Some(
                move |cpu: &mut Unicorn<'_, State<W>>, offset: u64, bytes: usize, value: u64| {
                    state::on_write(cpu, (base + offset) as u32, bytes as u8, value as u32);
                },
            ),
        )?;
    }
    cpu.add_block_hook(1, 0, |cpu, address, bytes| {
        state::on_block(cpu, address as u32, bytes)
    })?;
    cpu.add_intr_hook(|cpu, number| {
        cpu.get_data_mut().event = Event::Raised(number);
        if let Err(error) = cpu.emu_stop() {
            debug_assert!(false, "{error:?}");
        }
    })?;
    cpu.add_mem_hook(
        HookType::MEM_UNMAPPED | HookType::MEM_PROT,
        1,
        0,
        |cpu, kind, address, _, value| {
            let flash = FLASH_BASE..FLASH_BASE + super::FLASH_SIZE;
            let to_flash = kind == MemType::WRITE_PROT && flash.contains(&(address as u32));
            cpu.get_data_mut().invalid = Some((address as u32, value as u32, to_flash));
            false
        },
    )?;
    Ok(cpu)
}

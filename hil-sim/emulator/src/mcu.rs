//! The emulated microcontroller: its public interface.
use super::chip::Chip;
use super::corrections;
use super::cpu_setup::create_cpu;
use super::debugger::Halted;
use super::elf::{Firmware, RAM_BASE, RAM_SIZE};
use super::exceptions;
use super::halt::Halt;
use super::nvic::{self, EXCEPTIONS};
use super::profile::Stats;
use super::rcc::Clocks;
use super::run::RunLimit;
use super::state::{Cpu, State};
use super::stop::Stop;
use super::strict;
use super::{LegState, Wiring};
use std::sync::Arc;
use thermal_sim::FlashCells;
use thermal_sim::processor::{ChipState, ResetCause};
use unicorn_engine::uc_error;

/// Byte that fills the RAM at power-up.
const PAINT: u8 = 0xc5;

/// A reset that happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reset {
    /// Cycles since power-up.
    pub at: u64,
    /// Picoseconds since power-up.
    pub at_ps: u64,
    /// What caused it.
    pub cause: ResetCause,
}

/// An emulated STM32F446RE with an image in its flash.
pub struct Machine<W: Wiring + 'static> {
    pub(super) cpu: Cpu<'static, W>,
    pub(super) firmware: Firmware,
    pub(super) halt: Option<Halt>,
    /// Contents of the RAM at power-up.
    pub(super) initial_ram: Vec<u8>,
    pub(super) resets: Vec<Reset>,
    /// The halt that the debugger has not seen yet.
    pub(super) debugger_event: Option<Halted>,
    stopped: Option<Stop>,
}

impl<W: Wiring + 'static> Machine<W> {
    /// Powers the chip of a prepared board up with `firmware` in flash and `wiring` at its pins; nothing has run yet.
    ///
    /// # Errors
    /// [`Stop::Emulator`] when the CPU emulation cannot be set up.
    pub fn new(firmware: &Firmware, wiring: W) -> Result<Self, Stop> {
        Self::with_chip(firmware, wiring, &ChipState::default())
    }

    /// As [`Self::new`], with a chip in another state.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_chip(firmware: &Firmware, wiring: W, chip: &ChipState) -> Result<Self, Stop> {
        let flash: Arc<[u8]> = firmware.flash().into();
        let timing = chip.flash;
        let strict = chip.strict;
        let chip = Chip::new(wiring, flash.to_vec(), chip);
        let state = State::new(chip, Arc::clone(&flash), timing);
        let mut cpu = create_cpu(state, &flash).map_err(emulator)?;
        let initial_ram = vec![PAINT; RAM_SIZE as usize];
        cpu.mem_write(RAM_BASE.into(), &initial_ram).map_err(emulator)?;
        corrections::watch_ram(&mut cpu).map_err(emulator)?;
        if strict {
            let hook = |cpu: &mut Cpu<'_, W>, address: u64, _: u32| {
                strict::check(cpu, address as u32);
            };
            cpu.add_code_hook(1, 0, hook).map_err(emulator)?;
        }
        let mut machine = Self {
            cpu,
            firmware: firmware.clone(),
            halt: None,
            initial_ram,
            resets: Vec::new(),
            debugger_event: None,
            stopped: None,
        };
        exceptions::reset(&mut machine.cpu).map_err(|e| Stop::Emulator(format!("{e:?}")))?;
        machine.resets.push(Reset { at: 0, at_ps: 0, cause: ResetCause::PowerOn });
        Ok(machine)
    }

    /// Runs to the end of the basic block that reaches `cycle`, and services all device events until then.
    ///
    /// # Errors
    /// The reason why the run cannot continue; every later call returns it again.
    pub fn run_until(&mut self, cycle: u64) -> Result<(), Stop> {
        self.run_unless_stopped(RunLimit::Cycle(cycle))
    }

    /// Runs to a time in picoseconds since power-up; the image or a reset may change the clock on the way.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn run_until_ps(&mut self, ps: u64) -> Result<(), Stop> {
        self.run_unless_stopped(RunLimit::Ps(ps))
    }

    pub(super) fn chip(&self) -> &Chip<W> {
        self.cpu.get_data().chip_ref()
    }

    pub(super) fn chip_mut(&mut self) -> &mut Chip<W> {
        self.cpu.get_data_mut().chip()
    }

    fn run_unless_stopped(&mut self, until: RunLimit) -> Result<(), Stop> {
        if let Some(stop) = &self.stopped {
            return Err(stop.clone());
        }
        let result = self.run(until);
        if let Err(stop) = &result {
            self.stopped = Some(stop.clone());
        }
        result
    }

    /// The cells of the flash. The image reads changes in sectors 1 to 3, which hold the settings, if it leaves them blank. After
    /// a power failure in an operation the machine powers up again by itself, with other contents of the RAM.
    pub fn flash(&self) -> &FlashCells {
        &self.chip().flash.cells
    }

    /// The cells of the flash, for changes between two calls of [`run_until`](Self::run_until).
    pub fn flash_mut(&mut self) -> &mut FlashCells {
        &mut self.chip_mut().flash.cells
    }

    /// CPU cycles since power-up.
    pub fn now(&self) -> u64 {
        self.cpu.get_data().cycles
    }

    /// Time of a cycle since the clock last changed, ps since power-up.
    pub fn ps_at(&self, cycle: u64) -> u64 {
        self.chip().time.ps_at(cycle)
    }

    /// The clock tree as the image has set it.
    pub fn clocks(&self) -> Clocks {
        self.chip().clocks()
    }

    /// The wiring of the pins.
    pub fn wiring(&self) -> &W {
        &self.chip().wiring
    }

    /// The wiring of the pins, for changes between two calls of [`run_until`](Self::run_until).
    pub fn wiring_mut(&mut self) -> &mut W {
        &mut self.chip_mut().wiring
    }

    /// The host sends `bytes` to USART2, from now on or after the bytes that it is still sending.
    pub fn uart_send(&mut self, bytes: &[u8]) {
        let now = self.now();
        let chip = self.chip_mut();
        chip.usart_mut().send(bytes, now);
        chip.refresh_next(now);
    }

    /// Bit rate of the host, both ways; 1 Mbit/s at the start.
    pub fn set_host_baud(&mut self, baud: u32) {
        self.chip_mut().usart_mut().set_host_baud(baud);
    }

    /// How a timer drives a pin (port 0 is A), or its level as a general-purpose output.
    pub fn pwm(&mut self, port: u8, bit: u8) -> LegState {
        let now = self.now();
        self.chip_mut().pwm(port, bit, now)
    }

    /// Level that a general-purpose output drives (port 0 is A); `None` when the pin is no driven output.
    pub fn gpio_output(&self, port: u8, bit: u8) -> Option<bool> {
        self.chip().output(port, bit)
    }

    /// Records the blocks that an interrupt's handler executes, from its next activation on; `name` is that of
    /// [`InterruptStats`](super::InterruptStats).
    pub fn watch(&mut self, name: &str) {
        if let Some(exception) = (0..EXCEPTIONS).find(|n| nvic::name(*n) == name) {
            self.cpu.get_data_mut().profile.watch(exception);
        }
    }

    /// The record that [`Self::watch`] began.
    pub fn path(&self) -> Option<&super::ExecutionPath> {
        self.cpu.get_data().profile.path()
    }

    /// Address and estimated cycles of each instruction of a block in the flash; the first has what the core waited before it.
    pub fn instructions(&self, block: super::ExecutedBlock) -> Vec<(u32, u16)> {
        let super::ExecutedBlock { address, bytes, waited } = block;
        let start = (address & 0x07ff_ffff) as usize;
        let code = self.firmware.flash().get(start..start + usize::from(bytes));
        super::cost::instructions(code.unwrap_or_default())
            .map(|(at, cycles)| (address + at, cycles + if at == 0 { waited } else { 0 }))
            .collect()
    }

    /// Clears the statistics of the interrupts.
    pub fn restart_interrupt_stats(&mut self) {
        self.cpu.get_data_mut().profile.restart();
    }

    /// Statistics since power-up.
    pub fn stats(&self) -> Stats {
        let state = self.cpu.get_data();
        Stats {
            instructions: state.instructions,
            cycles: state.cycles,
            exceptions: state.exceptions,
            sleep_share: state.chip_ref().slept as f64 / state.cycles.max(1) as f64,
            masked_max: state.profile.masked_max(),
            interrupts: state.profile.interrupts(),
        }
    }

    /// All resets since and including power-up.
    pub fn resets(&self) -> &[Reset] {
        &self.resets
    }

    /// Deepest use of the main stack since power-up, bytes, found by the lowest changed byte. `None` if the image has no symbol
    /// for the end of the stack or of its static data (`_stack_end`, `__sheap`, `__euninit` or `__ebss`).
    pub fn stack_high_water(&self) -> Option<u32> {
        let bottom = self.stack_end()?;
        let top = self.firmware.initial_sp();
        let size = top.checked_sub(bottom)? as usize;
        let stack = self.cpu.mem_read_as_vec(u64::from(bottom), size).ok()?;
        let fresh = self.initial_ram.get(bottom.checked_sub(RAM_BASE)? as usize..)?;
        let untouched = stack.iter().zip(fresh).take_while(|(now, then)| now == then).count();
        Some((size - untouched) as u32)
    }

    /// Restores the contents that the RAM had at power-up.
    pub(super) fn restore_initial_ram(&mut self) -> Result<(), Stop> {
        let lost = self.cpu.mem_write(u64::from(RAM_BASE), &self.initial_ram);
        lost.map_err(emulator)
    }

    /// Lowest address of the stack; see [`Self::stack_high_water`].
    pub(super) fn stack_end(&self) -> Option<u32> {
        let symbols = ["_stack_end", "__sheap", "__euninit", "__ebss"];
        symbols.iter().find_map(|name| self.firmware.symbol(name))
    }

    /// Contents of RAM or flash.
    pub fn memory(&self, address: u32, bytes: usize) -> Option<Vec<u8>> {
        self.cpu.mem_read_as_vec(u64::from(address), bytes).ok()
    }
}

pub(super) fn emulator(error: uc_error) -> Stop {
    Stop::Emulator(format!("{error:?}"))
}

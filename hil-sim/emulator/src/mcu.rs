//! The machine as its user sees it.
use super::chip::Chip;
use super::elf::{Firmware, RAM_BASE, RAM_SIZE};
use super::exceptions;
use super::profile::Stats;
use super::rcc::Clocks;
use super::run::Until;
use super::setup::set_up;
use super::standstill::Standstill;
use super::state::{Cpu, State};
use super::stop::Stop;
use super::{LegState, Wiring};
use std::sync::Arc;
use thermal_sim::FlashCells;
use thermal_sim::processor::ResetCause;
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
    pub(super) standstill: Option<Standstill>,
    /// What the RAM held at power-up.
    pub(super) fresh_ram: Vec<u8>,
    pub(super) resets: Vec<Reset>,
    stopped: Option<Stop>,
}

impl<W: Wiring + 'static> Machine<W> {
    /// Powers the chip up with `firmware` in flash and `wiring` at its pins; nothing has run yet.
    ///
    /// # Errors
    /// [`Stop::Emulator`] when the CPU emulation cannot be set up.
    pub fn new(firmware: &Firmware, wiring: W) -> Result<Self, Stop> {
        let flash: Arc<[u8]> = firmware.flash().into();
        let state = State::new(Chip::new(wiring, flash.to_vec()), Arc::clone(&flash));
        let mut cpu = set_up(state, &flash).map_err(emulator)?;
        let fresh_ram = vec![PAINT; RAM_SIZE as usize];
        cpu.mem_write(RAM_BASE.into(), &fresh_ram)
            .map_err(emulator)?;
        let mut machine = Self {
            cpu,
            firmware: firmware.clone(),
            standstill: None,
            fresh_ram,
            resets: Vec::new(),
            stopped: None,
        };
        exceptions::reset(&mut machine.cpu).map_err(|e| Stop::Emulator(format!("{e:?}")))?;
        machine.resets.push(Reset {
            at: 0,
            at_ps: 0,
            cause: ResetCause::PowerOn,
        });
        Ok(machine)
    }

    /// Runs until `cycle` (to the end of the basic block that reaches it), with every device event up to there.
    ///
    /// # Errors
    /// The reason why the run cannot go on; the same again on every later call.
    pub fn run_until(&mut self, cycle: u64) -> Result<(), Stop> {
        self.run_on(Until::Cycle(cycle))
    }

    /// The same, to a time in picoseconds since power-up, whatever the image or a reset does to the clock on the way.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn run_until_ps(&mut self, ps: u64) -> Result<(), Stop> {
        self.run_on(Until::Ps(ps))
    }

    fn run_on(&mut self, until: Until) -> Result<(), Stop> {
        if let Some(stop) = &self.stopped {
            return Err(stop.clone());
        }
        let result = self.run(until);
        if let Err(stop) = &result {
            self.stopped = Some(stop.clone());
        }
        result
    }

    /// The cells of the flash. An image sees what changes of sectors 1 to 3, if it leaves them blank: the settings are
    /// there. When power fails in an operation, the machine powers up anew by itself, with other contents of the RAM.
    pub fn flash(&self) -> &FlashCells {
        &self.cpu.get_data().chip_ref().flash.cells
    }

    /// The same, to be changed between two calls of [`run_until`](Self::run_until).
    pub fn flash_mut(&mut self) -> &mut FlashCells {
        &mut self.cpu.get_data_mut().chip().flash.cells
    }

    /// CPU cycles since power-up.
    pub fn now(&self) -> u64 {
        self.cpu.get_data().cycles
    }

    /// Picoseconds since power-up.
    pub fn elapsed_ps(&self) -> u64 {
        self.ps_at(self.now())
    }

    /// Time of a cycle since the clock last changed, ps since power-up.
    pub fn ps_at(&self, cycle: u64) -> u64 {
        self.cpu.get_data().chip_ref().time.ps_at(cycle)
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
        self.cpu
            .get_data_mut()
            .chip()
            .usart_mut()
            .set_host_baud(baud);
    }

    /// How a timer drives a pin (port 0 is A), or its level as a general-purpose output.
    pub fn pwm(&mut self, port: u8, bit: u8) -> LegState {
        let now = self.now();
        self.cpu.get_data_mut().chip().pwm(port, bit, now)
    }

    /// Level that a general-purpose output drives (port 0 is A); `None` when the pin is no driven output.
    pub fn gpio_output(&self, port: u8, bit: u8) -> Option<bool> {
        self.cpu.get_data().chip_ref().output(port, bit)
    }

    /// Notes which blocks an interrupt's handler runs, from its next activation on; `name` is that of
    /// [`InterruptStats`](super::InterruptStats).
    pub fn watch(&mut self, name: &str) {
        if let Some(exception) =
            (0..super::nvic::EXCEPTIONS).find(|n| super::nvic::name(*n) == name)
        {
            self.cpu.get_data_mut().profile.watch(exception);
        }
    }

    /// What [`Self::watch`] has noted.
    pub fn path(&self) -> Option<&super::Path> {
        self.cpu.get_data().profile.path()
    }

    /// Address and estimated cycles of each instruction of a block in the flash.
    pub fn instructions(&self, (address, bytes): super::Ran) -> Vec<(u32, u16)> {
        let start = (address & 0x07ff_ffff) as usize;
        let code = self.firmware.flash().get(start..start + usize::from(bytes));
        super::cost::instructions(code.unwrap_or_default())
            .map(|(at, cycles)| (address + at, cycles))
            .collect()
    }

    /// Starts the figures of the interrupts anew.
    pub fn restart_interrupt_stats(&mut self) {
        self.cpu.get_data_mut().profile.restart();
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

    /// All resets, the first power-up included.
    pub fn resets(&self) -> &[Reset] {
        &self.resets
    }

    /// Deepest use of the main stack since power-up, bytes, by what has changed in RAM since then. `None` when the image has no
    /// symbol that tells where its static data end (`__sheap`, `__euninit` or `__ebss`).
    pub fn stack_high_water(&self) -> Option<u32> {
        let bottom = self.stack_end()?;
        let top = self.firmware.initial_sp();
        let size = top.checked_sub(bottom)? as usize;
        let stack = self.cpu.mem_read_as_vec(u64::from(bottom), size).ok()?;
        let fresh = self
            .fresh_ram
            .get(bottom.checked_sub(RAM_BASE)? as usize..)?;
        let untouched = stack
            .iter()
            .zip(fresh)
            .take_while(|(now, then)| now == then)
            .count();
        Some((size - untouched) as u32)
    }

    /// The RAM as power-up finds it.
    pub(super) fn lose_memory(&mut self) -> Result<(), Stop> {
        let lost = self.cpu.mem_write(u64::from(RAM_BASE), &self.fresh_ram);
        lost.map_err(emulator)
    }

    /// Lowest address that is the stack's; see [`Self::stack_high_water`].
    pub(super) fn stack_end(&self) -> Option<u32> {
        let symbols = ["_stack_end", "__sheap", "__euninit", "__ebss"];
        symbols.iter().find_map(|name| self.firmware.symbol(name))
    }

    /// Contents of RAM or flash, for tests and probes.
    pub fn memory(&self, address: u32, bytes: usize) -> Option<Vec<u8>> {
        self.cpu.mem_read_as_vec(u64::from(address), bytes).ok()
    }
}

pub(super) fn emulator(error: uc_error) -> Stop {
    Stop::Emulator(format!("{error:?}"))
}

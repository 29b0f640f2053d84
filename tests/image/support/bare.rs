//! A device without sensors: it answers the host and stores settings, and can do nothing else.

use stm32_emulator::{Firmware, Machine, Wiring};
use system_tests::flash::{BYTES, SECTOR};
use thermal_sim::FlashCells;
use thermal_sim::processor::ChipState;

/// Offset of the settings' sectors in the flash.
const BEGIN: usize = SECTOR;
/// Cycles within which a device starts: 1 s at 16 MHz.
pub const START: u64 = 16_000_000;
/// Cycles for a line and its answer: 12 ms at 180 MHz.
const LINE: u64 = 180_000 * 12;

/// The pins, of which only the serial line is connected.
#[derive(Default)]
pub struct Pins {
    received: Vec<u8>,
    /// End of the last conversion, cycles.
    pub converted_at: u64,
    /// End of the last byte to the host, cycles.
    pub sent_at: u64,
}

impl Wiring for Pins {
    fn adc(&mut self, _channel: u8, now: u64) -> u16 {
        self.converted_at = now;
        0
    }

    /// Nothing is connected but the emergency stop, PC13, which is not pressed.
    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        ((port, bit) == (2, 13)).then_some(true)
    }

    fn uart_tx(&mut self, byte: u8, at: u64, _baud: u32) {
        self.sent_at = at;
        self.received.push(byte);
    }
}

/// The microcontroller with an image, and the host's end of the line.
pub struct Bare(pub Machine<Pins>);

impl Bare {
    /// A device at power-up with these cells in the settings' sectors, before its first instruction.
    ///
    /// # Panics
    /// The emulation cannot be set up, or the cells have another size.
    pub fn switched_on(firmware: &Firmware, settings: &FlashCells) -> Self {
        Self::with_chip(firmware, settings, &ChipState::default())
    }

    /// The same, with a chip in this state.
    ///
    /// # Panics
    /// As [`Self::switched_on`].
    pub fn with_chip(firmware: &Firmware, settings: &FlashCells, chip: &ChipState) -> Self {
        let machine = Machine::with_chip(firmware, Pins::default(), chip);
        let mut machine = machine.expect("a machine");
        assert!(machine.flash_mut().load(BEGIN, settings.bytes()));
        machine.set_host_baud(1_000_000);
        Self(machine)
    }

    /// The same after its start.
    ///
    /// # Panics
    /// The image stops.
    pub fn new(firmware: &Firmware, settings: &FlashCells) -> Self {
        let mut device = Self::switched_on(firmware, settings);
        device.run(START);
        device
    }

    /// Runs for a number of cycles.
    ///
    /// # Panics
    /// The image stops.
    pub fn run(&mut self, cycles: u64) {
        let end = self.0.now() + cycles;
        self.0.run_until(end).expect("the image runs");
    }

    /// Runs in steps of `step` cycles until a condition holds.
    ///
    /// # Panics
    /// It does not hold within [`START`].
    pub fn run_until(&mut self, step: u64, holds: impl Fn(&Machine<Pins>) -> bool) {
        let end = self.0.now() + START;
        while !holds(&self.0) {
            assert!(self.0.now() < end, "not within {START} cycles");
            self.run(step);
        }
    }

    /// Takes the lines received from the device.
    pub fn received(&mut self) -> Vec<String> {
        let bytes = std::mem::take(&mut self.0.wiring_mut().received);
        String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect()
    }

    /// Sends a line, runs for a number of cycles, and takes the lines received.
    pub fn ask(&mut self, line: &str, cycles: u64) -> Vec<String> {
        self.0.uart_send(format!("{line}\n").as_bytes());
        self.run(cycles);
        self.received()
    }

    /// Sends a line and takes its answer.
    ///
    /// # Panics
    /// The answer is not one line.
    pub fn answer(&mut self, line: &str) -> String {
        let received = self.ask(line, LINE);
        let [answer] = received.as_slice() else {
            panic!("{line}: {received:?}");
        };
        answer.clone()
    }

    /// The answers to `settings 1` to `settings 8`.
    pub fn settings(&mut self) -> Vec<String> {
        (1..=9).map(|line| self.answer(&format!("settings {line}"))).collect()
    }

    /// The settings' sectors.
    pub fn cells(&self) -> FlashCells {
        FlashCells::new(self.0.flash().bytes()[BEGIN..BEGIN + BYTES].to_vec())
    }
}

//! A device without sensors, which can do no more than talk and keep settings.

use hil_sim::machine::{Cells, Firmware, Machine, Wiring};

use crate::flash::{BYTES, SECTOR};

/// Where the settings' sectors lie in the flash.
const BEGIN: usize = SECTOR;
/// Cycles of 16 MHz within which a device starts, and those of 180 MHz for a line and its answer.
pub const START: u64 = 16_000_000;
const LINE: u64 = 180_000 * 12;

/// What is at the pins: nothing but the host.
#[derive(Default)]
pub struct Pins {
    received: Vec<u8>,
    /// When the last conversion ended, cycles.
    pub converted_at: u64,
    /// When the last byte to the host did, cycles.
    pub sent_at: u64,
}

impl Wiring for Pins {
    fn adc(&mut self, _channel: u8, now: u64) -> u16 {
        self.converted_at = now;
        0
    }

    fn pin(&self, _port: u8, _bit: u8) -> Option<bool> {
        None
    }

    fn uart_tx(&mut self, byte: u8, at: u64, _baud: u32) {
        self.sent_at = at;
        self.received.push(byte);
    }
}

/// The microcontroller with an image, and the host's end of the line.
pub struct Bare(pub Machine<Pins>);

impl Bare {
    /// Switched on with these cells in the settings' sectors; nothing has run.
    ///
    /// # Panics
    /// The emulation cannot be set up, or the cells are no sectors.
    #[must_use]
    pub fn switched_on(firmware: &Firmware, settings: &Cells) -> Self {
        let mut machine = Machine::new(firmware, Pins::default()).expect("a machine");
        assert!(machine.flash_mut().load(BEGIN, settings.bytes()));
        machine.set_host_baud(1_000_000);
        Self(machine)
    }

    /// The same once it has started.
    ///
    /// # Panics
    /// It does not.
    #[must_use]
    pub fn new(firmware: &Firmware, settings: &Cells) -> Self {
        let mut device = Self::switched_on(firmware, settings);
        device.run(START);
        device
    }

    /// Lets cycles pass.
    ///
    /// # Panics
    /// The image cannot go on.
    pub fn run(&mut self, cycles: u64) {
        let end = self.0.now() + cycles;
        self.0.run_until(end).expect("the image runs");
    }

    /// Runs in steps of so many cycles until something is so.
    ///
    /// # Panics
    /// It is not within [`START`].
    pub fn run_until(&mut self, step: u64, is_so: impl Fn(&Machine<Pins>) -> bool) {
        let end = self.0.now() + START;
        while !is_so(&self.0) {
            assert!(self.0.now() < end, "not within {START} cycles");
            self.run(step);
        }
    }

    /// What the device has said.
    pub fn said(&mut self) -> Vec<String> {
        let said = std::mem::take(&mut self.0.wiring_mut().received);
        String::from_utf8_lossy(&said)
            .lines()
            .map(str::to_owned)
            .collect()
    }

    /// Sends a line, and lets cycles pass; what the device has said.
    pub fn ask(&mut self, line: &str, cycles: u64) -> Vec<String> {
        self.0.uart_send(format!("{line}\n").as_bytes());
        self.run(cycles);
        self.said()
    }

    /// Sends a line; its answer.
    ///
    /// # Panics
    /// That is not one line.
    pub fn tell(&mut self, line: &str) -> String {
        let said = self.ask(line, LINE);
        let [answer] = said.as_slice() else {
            panic!("{line}: {said:?}");
        };
        answer.clone()
    }

    /// The lines of its settings.
    pub fn settings(&mut self) -> Vec<String> {
        (1..=8)
            .map(|line| self.tell(&format!("settings {line}")))
            .collect()
    }

    /// The settings' sectors.
    #[must_use]
    pub fn cells(&self) -> Cells {
        Cells::new(self.0.flash().bytes()[BEGIN..BEGIN + BYTES].to_vec())
    }
}

//! The release image for five fingers in the emulated microcontroller, wired as its board module says.

use thermal_plant::bridge::Legs;
use thermal_plant::sensors::Channel;
use thermal_sim::World;
use thermal_sim::engine::{BAUD, Cost, DeviceReset, Engine as _, LineSplitter};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine};

use super::meter::Meter;
use super::one_finger::{ADC_INPUTS, Image, StartError, power_up, resets};
use crate::{Firmware, Machine, Stop, Wiring};

/// A pin: port (0 is A) and bit.
type Pin = (u8, u8);

/// What one finger's bridge is soldered to.
struct Bridge {
    in1: Pin,
    in2: Pin,
    enable: Pin,
    fault: Pin,
    /// Lets the comparator cut the supply.
    test: Pin,
}

const fn bridge(in1: Pin, in2: Pin, enable: Pin, fault: Pin, test: Pin) -> Bridge {
    Bridge {
        in1,
        in2,
        enable,
        fault,
        test,
    }
}

const A: u8 = 0;
const B: u8 = 1;
const C: u8 = 2;
const BRIDGES: [Bridge; FINGERS] = [
    bridge((A, 8), (A, 9), (B, 10), (A, 6), (C, 3)),
    bridge((A, 10), (A, 11), (B, 13), (A, 7), (C, 4)),
    bridge((C, 6), (C, 7), (B, 14), (A, 12), (C, 5)),
    bridge((C, 8), (C, 9), (B, 15), (B, 5), (B, 6)),
    bridge((B, 8), (B, 9), (B, 1), (B, 12), (B, 7)),
];
/// The lines that choose what the multiplexers show, lowest bit first; pulled down.
const SELECT: [Pin; 3] = [(C, 10), (C, 11), (C, 12)];
/// What the multiplexers and their followers take to settle, the most that the board allows, microseconds. A conversion
/// that ends earlier sees what was shown before.
const SETTLING_US: u64 = 11;

/// From the end of the first conversion to the first finger's first boundary, and from finger to finger,
/// picoseconds: the sixth of the 18 scans of a finger's turn ends 63 us after the first conversion, the seventh's first
/// conversion 67 us after it.
const FIRST_BOUNDARY_PS: u64 = 65_000_000;
const TURN_PS: u64 = 200_000_000;

/// The emulated microcontroller on five plants.
pub struct ImageHand {
    machine: Machine<Pins>,
    /// Time of the first boundary, ps since power-up.
    first_boundary_ps: u64,
    /// Boundaries that have been reached.
    boundaries: u64,
    lines: LineSplitter,
    meter: Meter,
}

impl ImageHand {
    /// Powers the device up and runs it to its first conversion.
    ///
    /// # Errors
    /// The image cannot run, or does not start its converter.
    pub fn new(firmware: &Firmware, worlds: [World; FINGERS]) -> Result<Self, StartError> {
        let mut machine = Machine::new(firmware, Pins::new(worlds))?;
        machine.set_host_baud(BAUD as u32);
        let started = power_up(&mut machine, |pins| pins.first_conversion)?;
        let cycles_per_us = u64::from(machine.clocks().hclk_hz) / 1_000_000;
        machine.wiring_mut().settling = SETTLING_US * cycles_per_us;
        let first_boundary_ps = machine.ps_at(started) + FIRST_BOUNDARY_PS;
        let meter = Meter::new(&mut machine);
        Ok(Self {
            machine,
            first_boundary_ps,
            boundaries: 0,
            lines: LineSplitter::default(),
            meter,
        })
    }
}

impl FiveFingerEngine for ImageHand {
    type Stop = Stop;

    const NAME: &'static str = Image::NAME;

    fn run_to(&mut self, _finger: usize) -> Result<(), Stop> {
        let at_ps = self.first_boundary_ps + self.boundaries * TURN_PS;
        self.boundaries += 1;
        self.machine.run_until_ps(at_ps)?;
        let tests = BRIDGES
            .each_ref()
            .map(|Bridge { test, .. }| self.machine.gpio_output(test.0, test.1) == Some(true));
        for (world, test) in self.machine.wiring_mut().worlds.iter_mut().zip(tests) {
            world.comparator_test(test);
        }
        Ok(())
    }

    fn world(&mut self, finger: usize) -> &mut World {
        &mut self.machine.wiring_mut().worlds[finger]
    }

    fn legs(&mut self, finger: usize) -> Legs {
        let Bridge {
            in1, in2, enable, ..
        } = &BRIDGES[finger];
        Legs {
            a: self.machine.pwm(in1.0, in1.1).into(),
            b: self.machine.pwm(in2.0, in2.1).into(),
            enabled: self.machine.gpio_output(enable.0, enable.1) == Some(true),
        }
    }

    fn send(&mut self, finger: usize, line: &[u8]) {
        // A blank line is nobody's.
        let address = if line == b"\n" {
            String::new()
        } else {
            format!("@{finger} ")
        };
        self.machine.uart_send(&[address.as_bytes(), line].concat());
    }

    fn receive(&mut self) -> Vec<(usize, String)> {
        self.lines
            .received()
            .append(&mut self.machine.wiring_mut().received);
        let lines = self.lines.complete().into_iter();
        // What the device says as a whole is put down to the first finger.
        lines
            .map(|line| match line.split_at_checked(3) {
                Some((prefix, rest)) => match prefix.as_bytes() {
                    [b'@', digit @ b'0'..=b'4', b' '] => {
                        (usize::from(digit - b'0'), rest.to_owned())
                    }
                    _ => (0, line),
                },
                None => (0, line),
            })
            .collect()
    }

    fn resets(&self) -> Vec<DeviceReset> {
        resets(&self.machine, self.first_boundary_ps)
    }

    fn reset_cost(&mut self) {
        self.meter = Meter::new(&mut self.machine);
    }

    fn cost(&self) -> Option<Cost> {
        self.meter.cost(&self.machine)
    }
}

/// What the pins of the microcontroller are soldered to.
struct Pins {
    worlds: [World; FINGERS],
    select: [bool; SELECT.len()],
    /// When the multiplexers were switched last, and how long they take to settle, cycles.
    switched_at: u64,
    settling: u64,
    /// Last code of each input.
    codes: [u16; ADC_INPUTS.len()],
    first_conversion: Option<u64>,
    received: Vec<u8>,
}

impl Pins {
    const fn new(worlds: [World; FINGERS]) -> Self {
        Self {
            worlds,
            select: [false; SELECT.len()],
            switched_at: 0,
            settling: 0,
            codes: [0; ADC_INPUTS.len()],
            first_conversion: None,
            received: Vec::new(),
        }
    }
}

impl Wiring for Pins {
    fn adc(&mut self, channel: u8, now: u64) -> u16 {
        /// An input that nothing is wired to floats; it reads as the middle of the range.
        const FLOATING: u16 = 0x800;
        self.first_conversion.get_or_insert(now);
        let Some(index) = ADC_INPUTS.iter().position(|input| *input == channel) else {
            return FLOATING;
        };
        if now >= self.switched_at + self.settling {
            let shown = self
                .select
                .iter()
                .rev()
                .fold(0, |shown, bit| 2 * shown + usize::from(*bit));
            let world = self.worlds.get_mut(shown);
            self.codes[index] = world.map_or(FLOATING, |world| world.convert(Channel::ALL[index]));
        }
        self.codes[index]
    }

    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        let finger = BRIDGES
            .iter()
            .position(|bridge| bridge.fault == (port, bit))?;
        Some(!self.worlds[finger].bridge_fault())
    }

    fn uart_tx(&mut self, byte: u8, _at: u64, _baud: u32) {
        self.received.push(byte);
    }

    fn output(&mut self, port: u8, bit: u8, level: Option<bool>, at: u64) {
        if let Some(line) = SELECT.iter().position(|pin| *pin == (port, bit)) {
            let level = level.unwrap_or(false);
            if self.select[line] != level {
                (self.select[line], self.switched_at) = (level, at);
            }
        }
    }
}

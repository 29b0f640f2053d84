//! The release image for five fingers in the emulated microcontroller, wired as its board.

use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::sensors::Channel;
use thermal_sim::World;
use thermal_sim::engine::{BAUD, Cost, DeviceReset, Engine as _};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine, FiveFingerRunner, run_scenes_on};
use thermal_sim::metrics::Figures;
use thermal_sim::processor::{MachineFault, NotInjected};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::meter::Meter;
use super::one_finger::{ADC_INPUTS, OneFingerBoard, StartError, power_up, resets};
use super::{
    A, B, Bridge, C, D, EMERGENCY_STOP, FIRST_BRIDGE, Pin, TEST_SIDE, TRIGGER_INPUT, bridge, inject,
};
use crate::{Firmware, Machine, Stop, Wiring};

const BRIDGES: [Bridge; FINGERS] = [
    FIRST_BRIDGE,
    bridge((A, 10), (A, 11), (B, 13), (A, 7), (A, 15)),
    bridge((C, 6), (C, 7), (B, 14), (A, 12), (D, 2)),
    bridge((C, 8), (C, 9), (B, 15), (B, 5), (B, 6)),
    bridge((B, 8), (B, 9), (B, 1), (B, 12), (B, 7)),
];
/// Select lines of the multiplexers, lowest bit first; pulled down.
const SELECT: [Pin; 3] = [(C, 10), (C, 11), (C, 12)];
/// Input for the parity of the select lines at the multiplexers.
const PARITY: Pin = (A, 5);
/// Longest settling time of the multiplexers and their followers that the board allows, microseconds. A conversion that ends
/// earlier has the code of the finger before.
const SETTLING_US: u64 = 11;
/// Scans of a finger's block of 18 that are converted after the settling.
const SETTLED_SCANS: usize = 17;

/// From the end of the first conversion to the first finger's first boundary, and from finger to finger,
/// picoseconds: the sixth of the 18 scans of a finger's turn ends 64 us after the first conversion, the seventh's first
/// conversion 67 us after it.
const FIRST_BOUNDARY_PS: u64 = 65_000_000;
const TURN_PS: u64 = 200_000_000;
const HALF_MICROSECOND_PS: u64 = 500_000;

/// The emulated microcontroller on five plants.
pub struct FiveFingerBoard {
    machine: Machine<Pins>,
    /// Time of the first boundary, ps since power-up.
    first_boundary_ps: u64,
    /// Boundaries reached so far.
    boundaries: u64,
    meter: Meter,
}

impl FiveFingerBoard {
    /// Powers the device up and runs it to its first conversion. The microcontroller is that of the first world.
    ///
    /// # Errors
    /// The image cannot run, or does not start its converter.
    pub fn new(firmware: &Firmware, worlds: [World; FINGERS]) -> Result<Self, StartError> {
        let chip = worlds[0].chip();
        let mut machine = Machine::with_chip(firmware, Pins::new(worlds), &chip)?;
        machine.set_host_baud(BAUD as u32);
        let started = power_up(&mut machine, |pins| pins.first_conversion)?;
        let cycles_per_us = u64::from(machine.clocks().hclk_hz) / 1_000_000;
        machine.wiring_mut().settling = SETTLING_US * cycles_per_us;
        let first_boundary_ps = machine.ps_at(started) + FIRST_BOUNDARY_PS;
        let meter = Meter::new(&mut machine);
        Ok(Self { machine, first_boundary_ps, boundaries: 0, meter })
    }

    /// Longest time from the end of a finger's block to the switch of the multiplexers, us.
    pub fn longest_switch_us(&self) -> f64 {
        let cycles = self.machine.wiring().longest_switch;
        1e6 * cycles as f64 / f64::from(self.machine.clocks().hclk_hz)
    }

    /// Runs the device on by a time, ps, from the last boundary on; at most to the next one.
    ///
    /// # Errors
    /// The device did something that is not modelled.
    pub fn run_beyond_boundary(&mut self, ps: u64) -> Result<(), Stop> {
        let last = self.boundaries.saturating_sub(1);
        self.machine.run_until_ps(self.first_boundary_ps + last * TURN_PS + ps.min(TURN_PS))
    }

    /// Longest time, us, for which the program has locked the control tick out since the start or the last
    /// [`reset_cost`](FiveFingerEngine::reset_cost), what preempts it excluded.
    pub fn longest_lock_us(&self) -> f64 {
        let cycles = self.machine.stats().masked_max;
        1e6 * cycles as f64 / f64::from(self.machine.clocks().hclk_hz)
    }
}

impl FiveFingerEngine for FiveFingerBoard {
    type Stop = Stop;

    const NAME: &'static str = OneFingerBoard::NAME;

    fn run_to(&mut self, _finger: usize) -> Result<(), Stop> {
        let at_ps = self.first_boundary_ps + self.boundaries * TURN_PS;
        self.boundaries += 1;
        self.machine.run_until_ps(at_ps)?;
        self.machine.wiring_mut().trigger = false;
        let tests = BRIDGES.each_ref().map(|bridge| bridge.comparator_test(&self.machine));
        for (world, test) in self.machine.wiring_mut().worlds.iter_mut().zip(tests) {
            world.comparator_test(test);
        }
        Ok(())
    }

    fn world(&mut self, finger: usize) -> &mut World {
        &mut self.machine.wiring_mut().worlds[finger]
    }

    fn legs(&mut self, finger: usize) -> BridgeOutputs {
        BRIDGES[finger].legs(&mut self.machine)
    }

    fn send(&mut self, bytes: &[u8]) {
        self.machine.uart_send(bytes);
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.machine.wiring_mut().received);
    }

    fn inject(&mut self, fault: &MachineFault) -> Result<(), NotInjected> {
        let (line, fault) = match *fault {
            MachineFault::SelectLineStuck { line, level } => {
                (line, SelectLineFault::Stuck(level != 0))
            }
            MachineFault::SelectLineOpen { line } => (line, SelectLineFault::Open),
            _ => return inject(&mut self.machine, fault),
        };
        let now = self.machine.now();
        let pins = self.machine.wiring_mut();
        pins.select_faults[usize::from(line) % SELECT.len()] = Some(fault);
        pins.update_selection(now);
        Ok(())
    }

    fn trigger(&mut self) -> Result<(), Stop> {
        let last_ps = self.first_boundary_ps + self.boundaries.saturating_sub(1) * TURN_PS;
        // So that the count of microseconds at the edge is not in doubt.
        self.machine.run_until_ps(last_ps + HALF_MICROSECOND_PS)?;
        self.machine.wiring_mut().trigger = true;
        Ok(())
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

/// The image on the board for five fingers; the scenes are run from power-up.
impl FiveFingerRunner for Firmware {
    fn run_five(&self, scenes: &[Scene; FINGERS]) -> anyhow::Result<Vec<(Outcome, Figures)>> {
        run_scenes_on(scenes, |worlds| Ok(FiveFingerBoard::new(self, worlds)?))
    }
}

/// A fault of a select line of the multiplexers.
#[derive(Clone, Copy)]
enum SelectLineFault {
    /// Shorted at the microcontroller's pin to this level.
    Stuck(bool),
    /// Broken between the pin and the pull-down at the multiplexers.
    Open,
}

/// The circuit at the pins of the microcontroller.
struct Pins {
    worlds: [World; FINGERS],
    /// Levels that the program drives on the select lines.
    driven: [bool; SELECT.len()],
    select_faults: [Option<SelectLineFault>; SELECT.len()],
    /// Levels at the multiplexers.
    select: [bool; SELECT.len()],
    /// Cycle at which the multiplexers were last switched, and their settling time in cycles.
    switched_at: u64,
    settling: u64,
    /// Number of conversions of the selected finger that are still to come, of those that belong to its block.
    conversions_left: usize,
    /// Cycle at which the block of the selected finger was complete, and the longest time from there to the next finger, cycles.
    block_ended: Option<u64>,
    longest_switch: u64,
    /// Last code of each input.
    codes: [u16; ADC_INPUTS.len()],
    first_conversion: Option<u64>,
    /// Level at the trigger input.
    trigger: bool,
    received: Vec<u8>,
}

impl Pins {
    const fn new(worlds: [World; FINGERS]) -> Self {
        Self {
            worlds,
            driven: [false; SELECT.len()],
            select_faults: [None; SELECT.len()],
            select: [false; SELECT.len()],
            switched_at: 0,
            settling: 0,
            // At power-up the first finger is selected, and all of its scans are settled.
            conversions_left: (SETTLED_SCANS + 1) * Channel::ALL.len(),
            block_ended: None,
            longest_switch: 0,
            codes: [0; ADC_INPUTS.len()],
            first_conversion: None,
            trigger: false,
            received: Vec::new(),
        }
    }

    /// The levels at the multiplexers after a change of the driven levels or of the faults at `at`.
    fn update_selection(&mut self, at: u64) {
        for (line, fault) in self.select_faults.iter().enumerate() {
            let level = match fault {
                None => self.driven[line],
                Some(SelectLineFault::Stuck(level)) => *level,
                Some(SelectLineFault::Open) => false,
            };
            if self.select[line] != level {
                (self.select[line], self.switched_at) = (level, at);
                if let Some(ended) = self.block_ended.take() {
                    self.longest_switch = self.longest_switch.max(at - ended);
                }
                self.conversions_left = SETTLED_SCANS * Channel::ALL.len();
            }
        }
    }
}

impl Wiring for Pins {
    fn adc(&mut self, channel: u8, now: u64) -> u16 {
        /// An unconnected input floats; it reads as the middle of the range.
        const FLOATING: u16 = 0x800;
        self.first_conversion.get_or_insert(now);
        let Some(index) = ADC_INPUTS.iter().position(|input| *input == channel) else {
            return FLOATING;
        };
        if now >= self.switched_at + self.settling {
            let finger =
                self.select.iter().rev().fold(0, |finger, bit| 2 * finger + usize::from(*bit));
            let Some(world) = self.worlds.get_mut(finger) else {
                self.codes[index] = FLOATING;
                return FLOATING;
            };
            if self.select_faults.iter().any(Option::is_some) {
                // A finger may be converted for longer than its turn.
                self.codes[index] = world.convert(Channel::ALL[index]);
                return self.codes[index];
            }
            // The noise of a finger's scans must not depend on when the program has switched, which other tasks delay by some
            // conversions of the scans that it drops: the first ones after the settling are drawn here, where they were lost;
            // those after the finger's last scan are not drawn.
            while self.conversions_left > 0 {
                let channel = (Channel::ALL.len() - self.conversions_left % Channel::ALL.len())
                    % Channel::ALL.len();
                self.conversions_left -= 1;
                let code = world.convert(Channel::ALL[channel]);
                if channel == index {
                    self.codes[index] = code;
                    break;
                }
            }
            if self.conversions_left == 0 {
                self.block_ended.get_or_insert(now);
            }
        }
        self.codes[index]
    }

    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        if (port, bit) == EMERGENCY_STOP {
            return Some(!self.worlds.iter().any(World::emergency_stop));
        }
        if (port, bit) == TEST_SIDE {
            return self.worlds.iter().find_map(World::side_stuck);
        }
        if (port, bit) == TRIGGER_INPUT {
            return Some(self.trigger);
        }
        if (port, bit) == PARITY {
            return Some(self.select.iter().filter(|level| **level).count() % 2 == 1);
        }
        let finger = BRIDGES.iter().position(|bridge| bridge.fault == (port, bit))?;
        Some(!self.worlds[finger].bridge_fault())
    }

    fn uart_tx(&mut self, byte: u8, _at: u64, _baud: u32) {
        self.received.push(byte);
    }

    fn output(&mut self, port: u8, bit: u8, level: Option<bool>, at: u64) {
        if let Some(line) = SELECT.iter().position(|pin| *pin == (port, bit)) {
            self.driven[line] = level.unwrap_or(false);
            self.update_selection(at);
        }
    }
}

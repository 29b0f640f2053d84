//! Boards around the machine: a NUCLEO-F446RE with one finger, and one with five on multiplexers; their engines.

use std::fmt::Display;

use thermal_plant::bridge::{BridgeOutputs, Leg};
use thermal_plant::comparator::ComparatorTest;
use thermal_sim::processor::{MachineFault, NotInjected};

use crate::{InjectError, LegState, Machine, Wiring};

mod five_fingers;
mod meter;
mod one_finger;

pub use five_fingers::FiveFingerBoard;
pub use one_finger::{OneFingerBoard, StartError};

/// A pin: port (0 is A) and bit.
type Pin = (u8, u8);

const A: u8 = 0;
const B: u8 = 1;
const C: u8 = 2;
const D: u8 = 3;

/// Output that selects the side of the comparators' tests: low hot, high cold. All fingers share it.
const TEST_SIDE: Pin = (B, 2);
/// Sense line of the emergency stop, low while it is pressed.
const EMERGENCY_STOP: Pin = (C, 13);

/// Trigger input.
const TRIGGER_INPUT: Pin = (B, 4);
/// Trigger output.
const TRIGGER_OUTPUT: Pin = (B, 3);

/// Pins of the bridge of one finger.
struct Bridge {
    in1: Pin,
    in2: Pin,
    enable: Pin,
    /// Fault line, low is a fault.
    fault: Pin,
    /// Output that connects the comparator's input to a level outside of its window.
    test: Pin,
}

/// The only bridge of the board for one finger, and the first for five.
const FIRST_BRIDGE: Bridge = bridge((A, 8), (A, 9), (B, 10), (A, 6), (C, 3));

const fn bridge(in1: Pin, in2: Pin, enable: Pin, fault: Pin, test: Pin) -> Bridge {
    Bridge { in1, in2, enable, fault, test }
}

impl Bridge {
    fn legs<W: Wiring>(&self, machine: &mut Machine<W>) -> BridgeOutputs {
        BridgeOutputs {
            a: machine.pwm(self.in1.0, self.in1.1).into(),
            b: machine.pwm(self.in2.0, self.in2.1).into(),
            enabled: is_high(machine, self.enable),
        }
    }

    fn comparator_test<W: Wiring>(&self, machine: &Machine<W>) -> ComparatorTest {
        match (is_high(machine, self.test), is_high(machine, TEST_SIDE)) {
            (false, _) => ComparatorTest::None,
            (true, false) => ComparatorTest::Hot,
            (true, true) => ComparatorTest::Cold,
        }
    }
}

impl From<LegState> for Leg {
    /// An input that nothing drives is pulled down.
    fn from(state: LegState) -> Self {
        Self::Duty(state.duty().unwrap_or(0.0))
    }
}

/// Whether a general-purpose output drives its pin high.
fn is_high<W: Wiring>(machine: &Machine<W>, pin: Pin) -> bool {
    machine.gpio_output(pin.0, pin.1) == Some(true)
}

/// Injects a fault of the microcontroller into the machine.
fn inject<W: Wiring>(machine: &mut Machine<W>, fault: &MachineFault) -> Result<(), NotInjected> {
    let injected = match *fault {
        MachineFault::RamBit { address, bit } => machine.flip_ram_bit(address, bit),
        MachineFault::CoreBit { register, bit } => machine.flip_core_bit(register, bit),
        MachineFault::RegisterBit { address, bit } => machine.flip_register_bit(address, bit),
        MachineFault::HungCore => {
            machine.hang_core();
            Ok(())
        }
        MachineFault::DebuggerHalt => {
            machine.halt_by_debugger();
            Ok(())
        }
        MachineFault::HseStopped => machine.stop_hse(),
        MachineFault::HseStarted => {
            machine.start_hse();
            Ok(())
        }
        MachineFault::AdcStopped => {
            machine.stop_adc();
            Ok(())
        }
        MachineFault::Adc2Stopped => {
            machine.stop_adc2();
            Ok(())
        }
        MachineFault::DmaStopped { controller, stream } => machine.stop_dma(controller, stream),
        MachineFault::BrownOut => machine.brown_out().map_err(InjectError::from),
        MachineFault::PowerCycle { seed } => machine.power_cycle(seed).map_err(InjectError::from),
        MachineFault::ResetPin => machine.pull_reset_pin().map_err(InjectError::from),
        MachineFault::SoftwareReset => machine.request_reset().map_err(InjectError::from),
        MachineFault::StackOverflow => machine.exhaust_stack(),
        MachineFault::SelectLineStuck { .. } | MachineFault::SelectLineOpen { .. } => {
            return Err(refused(fault, &"the board for one finger has no multiplexers"));
        }
    };
    injected.map_err(|reason| refused(fault, &reason))
}

fn refused(fault: &MachineFault, reason: &dyn Display) -> NotInjected {
    NotInjected::Refused { fault: *fault, reason: reason.to_string() }
}

//! Boards around the machine: a NUCLEO-F446RE with one finger, and one with five on multiplexers; their engines.

use thermal_plant::bridge::{Leg, Legs};

use crate::{LegState, Machine, Wiring};

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

/// Pins of the bridge of one finger.
struct Bridge {
    in1: Pin,
    in2: Pin,
    enable: Pin,
    /// Fault line, low is a fault.
    fault: Pin,
    /// Output that lets the comparator cut the supply, for its test.
    test: Pin,
}

/// The only bridge of the board for one finger, and the first for five.
const FIRST_BRIDGE: Bridge = bridge((A, 8), (A, 9), (B, 10), (A, 6), (C, 3));

const fn bridge(in1: Pin, in2: Pin, enable: Pin, fault: Pin, test: Pin) -> Bridge {
    Bridge {
        in1,
        in2,
        enable,
        fault,
        test,
    }
}

impl Bridge {
    fn legs<W: Wiring>(&self, machine: &mut Machine<W>) -> Legs {
        Legs {
            a: machine.pwm(self.in1.0, self.in1.1).into(),
            b: machine.pwm(self.in2.0, self.in2.1).into(),
            enabled: is_high(machine, self.enable),
        }
    }
}

impl From<LegState> for Leg {
    fn from(state: LegState) -> Self {
        state.duty().map_or(Self::Off, Self::Duty)
    }
}

/// Whether a general-purpose output drives its pin high.
fn is_high<W: Wiring>(machine: &Machine<W>, pin: Pin) -> bool {
    machine.gpio_output(pin.0, pin.1) == Some(true)
}

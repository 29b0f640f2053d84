//! The analog multiplexers, which connect the sensors of one finger to the converter.

use stm32f4xx_hal::gpio::outport::{OutPort, OutPort3};
use stm32f4xx_hal::gpio::{Input, PC10, PC11, PC12};
use thermal_display::device::Finger;

use super::FINGERS;

/// The three select lines, which are common to all multiplexers.
pub struct Multiplexer(OutPort3<'C', 10, 11, 12>);

impl Multiplexer {
    /// Scans after a switch that may still belong to the previous finger.
    pub const SETTLING_SCANS: usize = 2;

    /// Sets the select lines up and selects finger 0.
    pub fn new(bit0: PC10<Input>, bit1: PC11<Input>, bit2: PC12<Input>) -> Self {
        let lines = (
            bit0.into_push_pull_output(),
            bit1.into_push_pull_output(),
            bit2.into_push_pull_output(),
        );
        let mut multiplexer = Self(lines.outport());
        multiplexer.select(Finger::FIRST);
        multiplexer
    }

    /// Selects a finger. All lines change at the same time.
    pub fn select(&mut self, finger: Finger<FINGERS>) {
        self.0.write(finger.number().into());
    }
}

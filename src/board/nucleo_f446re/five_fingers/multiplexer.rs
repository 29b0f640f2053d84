//! The finger whose sensors the converter sees.

use stm32f4xx_hal::gpio::outport::{OutPort, OutPort3};
use stm32f4xx_hal::gpio::{Input, PC10, PC11, PC12};
use thermal_display::device::Finger;

use super::FINGERS;

/// The lines that choose.
pub struct Multiplexer(OutPort3<'C', 10, 11, 12>);

impl Multiplexer {
    /// Scans after a switch that may still show the finger before.
    pub const SETTLING_SCANS: usize = 2;

    /// Shows finger 0.
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

    /// Shows a finger; all lines change at once.
    pub fn select(&mut self, finger: Finger<FINGERS>) {
        self.0.write(finger.number().into());
    }
}

//! The analog multiplexers, which connect the sensors of one finger to the converter.

use stm32f4xx_hal::gpio::outport::{OutPort, OutPort3};
use stm32f4xx_hal::gpio::{Input, PC10, PC11, PC12};
use thermal_display::device::FingerIndex;

use super::FINGERS;

/// The three select lines PC10 to PC12, which are common to all eight analog multiplexers. They
/// select the finger whose sensors the multiplexers connect to the inputs of ADC1.
pub struct Multiplexer(OutPort3<'C', 10, 11, 12>);

impl Multiplexer {
    /// Number of scans to drop after each switch to another finger. During the first scan, of 11
    /// us, the control tick switches the multiplexers; during the second, multiplexers and voltage
    /// followers settle. Both scans may still contain samples of the previous finger.
    pub const SETTLING_SCANS: usize = 2;

    /// Sets up the three select lines as outputs and selects finger 0.
    pub fn new(bit0: PC10<Input>, bit1: PC11<Input>, bit2: PC12<Input>) -> Self {
        let lines = (
            bit0.into_push_pull_output(),
            bit1.into_push_pull_output(),
            bit2.into_push_pull_output(),
        );
        let mut multiplexer = Self(lines.outport());
        multiplexer.select(FingerIndex::FIRST);
        multiplexer
    }

    /// Connects the sensors of a finger to the converter. All three select lines change at the same
    /// time, so that no other finger is selected in between.
    pub fn select(&mut self, finger: FingerIndex<FINGERS>) {
        self.0.write(finger.index_u8().into());
    }
}

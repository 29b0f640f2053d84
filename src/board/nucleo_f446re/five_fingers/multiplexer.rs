//! The analog multiplexers, which connect the sensors of one finger to the converter.

use stm32f4xx_hal::gpio::outport::{OutPort, OutPort3};
use stm32f4xx_hal::gpio::{Input, PA5, PC10, PC11, PC12};
use thermal_display::device::FingerIndex;

use super::FINGERS;

/// The three select lines PC10 to PC12, which are common to all eight analog multiplexers. They
/// select the finger whose sensors the multiplexers connect to the inputs of ADC1.
pub struct Multiplexer {
    lines: OutPort3<'C', 10, 11, 12>,
    /// The parity of the levels at the far end of the select lines, from a gate there: high if an
    /// odd number of them is high. A line that is broken or shorted changes the parity of the
    /// fingers for which it should have the other level.
    parity: PA5<Input>,
}

impl Multiplexer {
    /// Number of scans to drop after each switch to another finger. During the first scan, of 11
    /// us, the control tick switches the multiplexers; during the second, multiplexers and voltage
    /// followers settle. Both scans may still contain samples of the previous finger.
    pub const SETTLING_SCANS: usize = 2;

    /// Sets up the three select lines as outputs and selects finger 0.
    pub fn new(
        bit0: PC10<Input>,
        bit1: PC11<Input>,
        bit2: PC12<Input>,
        parity: PA5<Input>,
    ) -> Self {
        let lines = (
            bit0.into_push_pull_output(),
            bit1.into_push_pull_output(),
            bit2.into_push_pull_output(),
        );
        let mut multiplexer = Self {
            lines: lines.outport(),
            // With the pull-up a broken wire reads as odd, which finger 0 is not.
            parity: parity.into_pull_up_input(),
        };
        multiplexer.select(FingerIndex::FIRST);
        multiplexer
    }

    /// Connects the sensors of a finger to the converter. All three select lines change at the same
    /// time, so that no other finger is selected in between.
    pub fn select(&mut self, finger: FingerIndex<FINGERS>) {
        self.lines.write(finger.index_u8().into());
    }

    /// Whether the levels at the far end of the select lines can be those that select `finger`.
    /// Read at the end of the finger's turn, when they have long settled.
    pub fn can_have_selected(&self, finger: FingerIndex<FINGERS>) -> bool {
        self.parity.is_high() == (finger.index_u8().count_ones() % 2 == 1)
    }
}

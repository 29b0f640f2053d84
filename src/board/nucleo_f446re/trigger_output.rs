//! The trigger output: a pulse marks an event of any finger.

use stm32f4xx_hal::gpio::{Debugger, Output, PB3};
use thermal_display::device::FingerIndex;

use super::wiring::FINGERS;

/// PB3, high while any finger marks an event.
pub struct TriggerOutput {
    pin: PB3<Output>,
    /// The fingers that mark an event, one bit each.
    marking: u8,
}

impl TriggerOutput {
    /// Sets up the pin, low.
    pub fn new(pin: PB3<Debugger>) -> Self {
        Self { pin: pin.into_push_pull_output(), marking: 0 }
    }

    /// Sets what a finger's tick demands; it stays until the finger's next tick.
    pub fn set(&mut self, finger: FingerIndex<FINGERS>, high: bool) {
        if high || self.marking != 0 {
            self.update_pin(finger, high);
        }
    }

    #[cold]
    #[inline(never)]
    fn update_pin(&mut self, finger: FingerIndex<FINGERS>, high: bool) {
        let bit = 1 << finger.index_u8();
        self.marking = self.marking & !bit | if high { bit } else { 0 };
        self.pin.set_state((self.marking != 0).into());
    }
}

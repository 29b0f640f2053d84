//! The sense line of the emergency stop.

use stm32f4xx_hal::gpio::{Input, PC13};

/// PC13: high through the second contact of the emergency stop, low while the button is pressed.
pub struct EmergencyStop(PC13<Input>);

impl EmergencyStop {
    /// Sets up the pin. The weak internal pull-down makes a broken wire read as a pressed button.
    pub fn new(pin: PC13<Input>) -> Self {
        Self(pin.into_pull_down_input())
    }

    /// Whether the button is pressed, or the wire is broken.
    pub fn is_pressed(&self) -> bool {
        self.0.is_low()
    }
}

//! Driver of an H-bridge with two logic inputs and an enable input, such as the DRV8873 in IN/IN
//! mode.
//!
//! | enable | IN1 | IN2 | outputs                                    |
//! |--------|-----|-----|--------------------------------------------|
//! | low    | any | any | high-impedance                             |
//! | high   | 0   | 0   | high-impedance                             |
//! | high   | 1   | 0   | OUT1 high, OUT2 low: the display is cooled |
//! | high   | 0   | 1   | OUT1 low, OUT2 high: the display is warmed |
//! | high   | 1   | 1   | both at the same level                     |
//!
//! "Off" means the first two rows and never the last one, which short-circuits the Peltier module:
//! a module whose faces differ in temperature is a voltage source, and the current through a short
//! circuit would carry heat.

use core::convert::Infallible;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use thermal_device::drive::Duty;

/// A bridge on two PWM channels with the same period and an output pin of the microcontroller.
#[derive(Debug)]
pub struct Bridge<In1, In2, Enable> {
    in1: In1,
    in2: In2,
    enable: Enable,
}

impl<In1, In2, Enable> Bridge<In1, In2, Enable>
where
    In1: SetDutyCycle<Error = Infallible>,
    In2: SetDutyCycle<Error = Infallible>,
    Enable: OutputPin<Error = Infallible>,
{
    /// Takes the pins of a bridge and turns the bridge off.
    pub fn new(in1: In1, in2: In2, enable: Enable) -> Self {
        let mut bridge = Self { in1, in2, enable };
        bridge.off();
        bridge
    }

    /// Turns the bridge off: makes both outputs high-impedance, so that no current flows through the module.
    pub fn off(&mut self) {
        let Ok(()) = self.enable.set_low();
        let Ok(()) = self.in1.set_duty_cycle_fully_off();
        let Ok(()) = self.in2.set_duty_cycle_fully_off();
    }

    /// Drives the module with a mean voltage of `duty` times the supply voltage; positive values
    /// cool the display.
    pub fn drive(&mut self, duty: Duty) {
        let (in1, in2) = duty.half_bridge_on_times(self.in1.max_duty_cycle());
        let Ok(()) = self.in1.set_duty_cycle(in1);
        let Ok(()) = self.in2.set_duty_cycle(in2);
        let Ok(()) = self.enable.set_high();
    }
}

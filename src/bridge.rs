//! Driver of an H-bridge with two logic inputs and an enable input, such as the DRV8702-Q1 with
//! four MOSFETs and an AND gate in front of each input.
//!
//! | enable | IN1 | IN2 | outputs                                    |
//! |--------|-----|-----|--------------------------------------------|
//! | low    | any | any | high-impedance                             |
//! | high   | 0   | 0   | high-impedance                             |
//! | high   | 1   | 0   | OUT1 high, OUT2 low: the display is cooled |
//! | high   | 0   | 1   | OUT1 low, OUT2 high: the display is warmed |
//! | high   | 1   | 1   | both low: the current circulates           |
//!
//! "Off" means the first two rows and never the last one, which short-circuits the Peltier module:
//! a module whose faces differ in temperature is a voltage source, and the current through a short
//! circuit would carry heat.

use core::convert::Infallible;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use thermal_device::drive::Duty;

/// An H-bridge that drives a Peltier module. `In1` and `In2` are the PWM channels of its two logic
/// inputs, with the same period; `Enable` is the output pin that is high while the bridge drives.
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
    /// Creates the driver from the two PWM channels and the enable pin of a bridge, and turns the
    /// bridge off.
    pub fn new(in1: In1, in2: In2, enable: Enable) -> Self {
        let mut bridge = Self { in1, in2, enable };
        bridge.make_outputs_high_impedance();
        bridge
    }

    /// Turns the bridge off: makes both outputs high-impedance, so that the bridge drives no
    /// current through the Peltier module.
    pub fn make_outputs_high_impedance(&mut self) {
        let Ok(()) = self.enable.set_low();
        let Ok(()) = self.in1.set_duty_cycle_fully_off();
        let Ok(()) = self.in2.set_duty_cycle_fully_off();
    }

    /// Drives the Peltier module with a mean voltage of `duty` times the supply voltage. `duty` is
    /// -0.9 to 0.9; positive values cool the display, negative ones warm it.
    pub fn drive(&mut self, duty: Duty) {
        let (in1, in2) = duty.input_high_times(self.in1.max_duty_cycle());
        let Ok(()) = self.in1.set_duty_cycle(in1);
        let Ok(()) = self.in2.set_duty_cycle(in2);
        let Ok(()) = self.enable.set_high();
    }
}

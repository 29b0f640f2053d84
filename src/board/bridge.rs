//! An H-bridge with two logic inputs and an enable input (DRV8873 and its kin, IN/IN mode).
//!
//! | enable | IN1 | IN2 | outputs                                    |
//! |--------|-----|-----|--------------------------------------------|
//! | low    | any | any | high-impedance                             |
//! | high   | 0   | 0   | high-impedance                             |
//! | high   | 1   | 0   | OUT1 high, OUT2 low: the display is cooled |
//! | high   | 0   | 1   | OUT1 low, OUT2 high: the display is warmed |
//! | high   | 1   | 1   | both at the same level                     |
//!
//! Off is the first two rows, never the last one: a module whose faces differ in temperature is a voltage
//! source, and a short across it carries heat.

use core::convert::Infallible;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use thermal_display::drive::Duty;

/// The bridge on two PWM channels and a pin of the microcontroller, which cannot fail.
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
    /// Takes the inputs of the bridge and turns it off.
    pub fn new(in1: In1, in2: In2, enable: Enable) -> Self {
        let mut bridge = Self { in1, in2, enable };
        bridge.off();
        bridge
    }

    /// Both outputs high-impedance.
    pub fn off(&mut self) {
        let Ok(()) = self.enable.set_low();
        let Ok(()) = self.in1.set_duty_cycle_fully_off();
        let Ok(()) = self.in2.set_duty_cycle_fully_off();
    }

    /// Drives with a mean voltage of `duty` of the supply, rounded to the nearest step of the PWM.
    ///
    /// Slow decay: one input stays high while the other takes away its share of the period, so the current
    /// circulates between the pulses and the mean voltage is the duty times the supply in either
    /// direction. With fast decay (the other input low) it would also depend on the current.
    pub fn drive(&mut self, duty: Duty) {
        let fraction = duty.fraction().to_bits();
        let (in1, in2) = if fraction >= 0 {
            (
                self.in1.max_duty_cycle(),
                remainder(self.in2.max_duty_cycle(), fraction),
            )
        } else {
            (
                remainder(self.in1.max_duty_cycle(), fraction),
                self.in2.max_duty_cycle(),
            )
        };
        let Ok(()) = self.in1.set_duty_cycle(in1);
        let Ok(()) = self.in2.set_duty_cycle(in2);
        let Ok(()) = self.enable.set_high();
    }
}

/// `full * (1 - |fraction|)` in steps of the PWM; `fraction` in units of 2^-15.
fn remainder(full: u16, fraction: i16) -> u16 {
    let taken = (u32::from(full) * u32::from(fraction.unsigned_abs()) + (1 << 14)) >> 15;
    // `taken` is at most `full`, as |fraction| <= 1.
    full.saturating_sub(taken as u16)
}

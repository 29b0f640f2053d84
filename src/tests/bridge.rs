//! The bridge driver, checked against the truth table of a bridge in IN/IN mode.

use std::cell::Cell;
use std::convert::Infallible;

use crate::bridge::Bridge;
use crate::device::PWM_PERIOD_STEPS_OF_ONE_FINGER;
use crate::device::drive::Duty;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use fixed::types::I1F15;

/// Steps of a PWM period.
const STEPS: u16 = PWM_PERIOD_STEPS_OF_ONE_FINGER;

/// Levels of the lines between microcontroller and bridge: compare values of the inputs, in steps,
/// and the enable line.
#[derive(Default)]
struct Lines {
    in1: Cell<u16>,
    in2: Cell<u16>,
    enable: Cell<bool>,
}

impl Lines {
    fn bridge(&self) -> Bridge<Compare<'_>, Compare<'_>, Enable<'_>> {
        Bridge::new(Compare(&self.in1), Compare(&self.in2), Enable(&self.enable))
    }

    /// Mean of OUT1 - OUT2 over one period, in units of the supply voltage; `None` if the outputs
    /// are high-impedance during any step. Both inputs rise together at the start of a period.
    fn mean_voltage(&self) -> Option<f64> {
        let mut sum = 0;
        for step in 0..STEPS {
            sum += match (self.enable.get(), step < self.in1.get(), step < self.in2.get()) {
                (false, ..) | (true, false, false) => return None,
                (true, true, false) => 1,
                (true, false, true) => -1,
                (true, true, true) => 0,
            };
        }
        Some(f64::from(sum) / f64::from(STEPS))
    }
}

struct Compare<'a>(&'a Cell<u16>);

impl pwm::ErrorType for Compare<'_> {
    type Error = Infallible;
}

impl SetDutyCycle for Compare<'_> {
    fn max_duty_cycle(&self) -> u16 {
        STEPS
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        assert!(duty <= STEPS, "compare value {duty} beyond the period");
        self.0.set(duty);
        Ok(())
    }
}

struct Enable<'a>(&'a Cell<bool>);

impl digital::ErrorType for Enable<'_> {
    type Error = Infallible;
}

impl OutputPin for Enable<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(true);
        Ok(())
    }
}

#[test]
fn mean_voltage_is_the_duty_to_half_a_step() {
    let lines = Lines::default();
    let mut bridge = lines.bridge();
    for bits in i16::MIN..=i16::MAX {
        let duty = Duty::saturating(I1F15::from_bits(bits));
        bridge.drive(duty);
        let voltage = lines.mean_voltage().expect("driven throughout the period");
        // In steps, which are exact: a duty may lie in the middle between two of them.
        let steps = (voltage * f64::from(STEPS)).round();
        let error = steps - duty.fraction().to_num::<f64>() * f64::from(STEPS);
        assert!(error.abs() <= 0.5, "duty {duty:?} gives {voltage}");
    }
}

#[test]
fn off_makes_the_outputs_high_impedance_by_the_enable_line_and_by_the_inputs() {
    let lines = Lines { in1: STEPS.into(), in2: STEPS.into(), enable: true.into() };
    let mut bridge = lines.bridge();
    let is_off = || (lines.in1.get(), lines.in2.get(), lines.enable.get()) == (0, 0, false);
    assert!(is_off(), "a new bridge is off");
    for bits in [i16::MAX, 0, i16::MIN] {
        bridge.drive(Duty::saturating(I1F15::from_bits(bits)));
        bridge.make_outputs_high_impedance();
        assert!(is_off(), "off after duty {bits}");
    }
}

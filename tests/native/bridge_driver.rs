//! The bridge driver against the truth table of an IN/IN bridge.

#[path = "../../src/board/bridge.rs"]
mod bridge;

use std::cell::Cell;
use std::convert::Infallible;

use bridge::Bridge;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use fixed::types::I1F15;
use thermal_display::drive::Duty;

/// Steps of the PWM on the NUCLEO-F446RE.
const STEPS: u16 = 1875;

/// The wires between microcontroller and bridge.
#[derive(Default)]
struct Wires {
    in1: Cell<u16>,
    in2: Cell<u16>,
    enable: Cell<bool>,
}

impl Wires {
    fn bridge(&self) -> Bridge<Compare<'_>, Compare<'_>, Enable<'_>> {
        Bridge::new(Compare(&self.in1), Compare(&self.in2), Enable(&self.enable))
    }

    /// Mean of OUT1 - OUT2 in units of the supply; none if an output is high-impedance at any time of
    /// the period. Both inputs rise together at the start of a period.
    fn mean_voltage(&self) -> Option<f64> {
        let mut sum = 0;
        for step in 0..STEPS {
            sum += match (
                self.enable.get(),
                step < self.in1.get(),
                step < self.in2.get(),
            ) {
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
fn the_mean_bridge_voltage_is_the_duty_to_half_a_pwm_step() {
    let wires = Wires::default();
    let mut bridge = wires.bridge();
    for bits in i16::MIN..=i16::MAX {
        let duty = Duty::saturating(I1F15::from_bits(bits));
        bridge.drive(duty);
        let voltage = wires.mean_voltage().expect("driven throughout the period");
        let error = voltage - duty.fraction().to_num::<f64>();
        assert!(
            error.abs() <= 0.5 / f64::from(STEPS),
            "duty {duty:?} gives {voltage}"
        );
    }
}

#[test]
fn off_makes_both_outputs_high_impedance_by_each_input_alone() {
    let wires = Wires {
        in1: STEPS.into(),
        in2: STEPS.into(),
        enable: true.into(),
    };
    let mut bridge = wires.bridge();
    let is_off = || (wires.in1.get(), wires.in2.get(), wires.enable.get()) == (0, 0, false);
    assert!(is_off(), "a new bridge is off");
    for bits in [i16::MAX, 0, i16::MIN] {
        bridge.drive(Duty::saturating(I1F15::from_bits(bits)));
        bridge.off();
        assert!(is_off(), "off after duty {bits}");
    }
}

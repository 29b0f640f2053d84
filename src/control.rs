//! Set-point to current, and current to bridge voltage.

use contact_model::fixed_point::Celsius;
use fixed::types::{I1F15, I16F16};

use crate::TICK_HZ;
use crate::drive::{Current, Duty};
use crate::guard::Setpoint;
use crate::settings::{Gains, Module};

/// Binary places of the integral: a millikelvin for one tick still counts.
const STATE_BITS: u32 = 52;
/// Binary places of error, gains and current.
const ERROR_BITS: u32 = 22;
const GAIN_BITS: u32 = 16;
const RATE_BITS: u32 = STATE_BITS - ERROR_BITS;
const CURRENT_BITS: u32 = 24;

/// Proportional-integral law with limited output.
///
/// The integral stops while the output is at its limit and the error would drive it further, so there is
/// nothing to unwind afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pi {
    /// A/K.
    proportional: i32,
    /// A per K and tick.
    integral: i32,
    limit: Current,
    /// Integral part of the output, A; never beyond the limit.
    state: i64,
}

impl Pi {
    /// `f64`, once; gains saturate at 32768 A/K and 2 A/K a tick.
    #[must_use]
    pub fn new(gains: &Gains, limit_a: f64) -> Self {
        let per_tick = gains.proportional_a_k / (gains.integral_s * f64::from(TICK_HZ));
        Self {
            proportional: libm::ldexp(gains.proportional_a_k, GAIN_BITS as i32) as i32,
            integral: libm::ldexp(per_tick, RATE_BITS as i32) as i32,
            limit: Current::saturating_from_num(limit_a),
            state: 0,
        }
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.state = 0;
    }

    /// The largest current that [`Self::update`] returns.
    #[must_use]
    pub const fn limit(&self) -> Current {
        self.limit
    }

    /// Current for one tick; positive cools, so it rises when the display is above its set-point.
    ///
    /// No sum overflows: the state stays within 128 A (59 bits), the integral's step within 2^10 A, the
    /// proportional part within 2^24 A of 38 bits.
    pub fn update(&mut self, setpoint: Setpoint, display: Celsius) -> Current {
        let error = i64::from(display.saturating_sub(setpoint.celsius()).to_bits());
        let proportional = (error * i64::from(self.proportional)) >> (ERROR_BITS + GAIN_BITS - CURRENT_BITS);
        let state = self.state.saturating_add(error * i64::from(self.integral));
        let limit = i64::from(self.limit.to_bits());
        let wanted = proportional + (state >> (STATE_BITS - CURRENT_BITS));
        let output = wanted.clamp(-limit, limit);
        if output == wanted || (wanted > output) != (error > 0) {
            let limit = limit << (STATE_BITS - CURRENT_BITS);
            self.state = state.clamp(-limit, limit);
        }
        Current::from_bits(output as i32)
    }
}

/// The module's electrical side: `V = R I + a (T_sink - T_display) + V_dead`, where `V_dead` is what the bridge loses
/// in its dead times. It opposes the current, and grows with it until its ripple does not reach zero any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voltage {
    /// Part of the supply per A.
    per_a: I16F16,
    /// Part of the supply per K.
    per_k: I16F16,
    /// Part of the supply lost in dead times, and that per A while the current is small.
    dead: I16F16,
    dead_per_a: I16F16,
}

impl Voltage {
    /// `f64`, once.
    #[must_use]
    pub fn new(module: &Module) -> Self {
        Self {
            per_a: I16F16::saturating_from_num(module.resistance_ohm / module.supply_v),
            per_k: I16F16::saturating_from_num(module.seebeck_v_k / module.supply_v),
            dead: I16F16::saturating_from_num(module.dead_time_v / module.supply_v),
            dead_per_a: I16F16::saturating_from_num(module.dead_time_v / (module.supply_v * module.ripple_a)),
        }
    }

    /// Mean voltage for a current, as a part of the supply.
    #[must_use]
    pub fn duty(&self, current: Current, sink: Celsius, display: Celsius) -> Duty {
        let across = I16F16::saturating_from_num(sink.saturating_sub(display));
        let current = I16F16::from_num(current);
        let resistive = current.saturating_mul(self.per_a);
        let dead = current
            .saturating_mul(self.dead_per_a)
            .clamp(-self.dead, self.dead);
        let voltage = resistive
            .saturating_add(dead)
            .saturating_add(across.saturating_mul(self.per_k));
        Duty::saturating(I1F15::saturating_from_num(voltage))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn pi() -> Pi {
        Pi::new(
            &Gains {
                proportional_a_k: 2.0,
                integral_s: 0.5,
            },
            6.0,
        )
    }

    fn at(t_c: f64) -> Celsius {
        Celsius::from_num(t_c)
    }

    /// A constant error e gives kp e (1 + t / ti).
    #[test]
    fn pi_answers_a_step_as_its_equation_says() {
        let (setpoint, mut pi) = (Setpoint::limited(at(25.0)).0, pi());
        for tick in 1..=1000 {
            let expected = 2.0 * 0.5 * (1.0 + f64::from(tick) * 1e-3 / 0.5);
            let output = pi.update(setpoint, at(25.5)).to_num::<f64>();
            assert!(
                (output - expected).abs() < 1e-4,
                "tick {tick}: {output}, expected {expected}"
            );
        }
    }

    #[test]
    fn pi_holds_its_limit_and_leaves_it_without_delay() {
        let (setpoint, mut pi) = (Setpoint::limited(at(25.0)).0, pi());
        for _ in 0..10_000 {
            assert_eq!(pi.update(setpoint, at(40.0)), Current::lit("6"));
        }
        // Without anti-windup the integral would hold 600 A by now.
        let output = pi.update(setpoint, at(24.0));
        assert!(output <= Current::lit("4"), "{output}");
    }

    #[test]
    fn pi_is_odd_in_its_error() {
        let (setpoint, mut up, mut down) = (Setpoint::limited(at(30.0)).0, pi(), pi());
        for _ in 0..100 {
            let (a, b) = (up.update(setpoint, at(30.25)), down.update(setpoint, at(29.75)));
            assert!((a + b).abs() <= Current::from_bits(4));
        }
    }

    #[test]
    fn voltage_is_resistive_plus_seebeck_plus_dead_time() {
        let voltage = Voltage::new(&Settings::default().module);
        // All of the dead time's 0.397 V from 0.5 A on, in proportion below.
        for (current_a, dead_v) in [
            (3.0, 0.397),
            (0.25, 0.1985),
            (0.0, 0.0),
            (-0.1, -0.0794),
            (-6.0, -0.397),
        ] {
            let duty = voltage
                .duty(Current::saturating_from_num(current_a), at(30.0), at(20.0))
                .fraction()
                .to_num::<f64>();
            let expected = (current_a * 1.25 + 0.0273 * 10.0 + dead_v) / 12.0;
            assert!((duty - expected).abs() < 3e-4, "{duty}, expected {expected}");
        }
    }
}

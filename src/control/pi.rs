//! Temperature error to current: the plain loop.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::guard::Setpoint;
use crate::settings::Gains;

/// Binary places of the integral: a millikelvin for one tick still counts.
const STATE_BITS: u32 = 52;
/// Binary places of error, gains and current.
const ERROR_BITS: u32 = 22;
const GAIN_BITS: u32 = 16;
const RATE_BITS: u32 = STATE_BITS - ERROR_BITS;
const CURRENT_BITS: u32 = 24;

/// How often the loop looks at its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Period {
    /// At every control tick.
    EveryTick,
    /// Ten times a second, as the thesis's display; the current is held in between.
    TenthOfASecond,
}

/// Proportional-integral law with limited output.
///
/// The integral stops while the output is at its limit and the error would drive it further, so there is
/// nothing to unwind afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pi {
    /// A/K.
    proportional: i32,
    /// A per K and update.
    integral: i32,
    limit: Current,
    /// Ticks from one update of the output to the next.
    period: u32,
    /// Ticks until that.
    wait: u32,
    output: Current,
    /// Integral part of the output, A; never beyond the limit.
    state: i64,
}

impl Pi {
    /// `f64`; gains saturate at 32768 A/K and 2 A/K an update.
    #[must_use]
    pub fn new(gains: &Gains, limit_a: f64, period: Period) -> Self {
        let mut pi = Self {
            proportional: 0,
            integral: 0,
            limit: Current::saturating_from_num(limit_a),
            period: match period {
                Period::EveryTick => 1,
                Period::TenthOfASecond => TICK_HZ / 10,
            },
            wait: 0,
            output: Current::ZERO,
            state: 0,
        };
        pi.retune(gains);
        pi
    }

    /// Other gains; the integral part of the output stays. `f64`.
    pub fn retune(&mut self, gains: &Gains) {
        let per_update =
            gains.proportional_a_k * f64::from(self.period) / (gains.integral_s * f64::from(TICK_HZ));
        self.proportional = libm::ldexp(gains.proportional_a_k, GAIN_BITS as i32) as i32;
        self.integral = libm::ldexp(per_update, RATE_BITS as i32) as i32;
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        (self.state, self.wait, self.output) = (0, 0, Current::ZERO);
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
        if self.wait == 0 {
            self.wait = self.period;
            self.output = self.respond(display.saturating_sub(setpoint.celsius()));
        }
        self.wait -= 1;
        self.output
    }

    /// Answer to an error that is positive when the display is too warm, whatever the period.
    pub fn respond(&mut self, error: Celsius) -> Current {
        let error = i64::from(error.to_bits());
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

#[cfg(test)]
mod tests {
    use super::*;

    fn pi() -> Pi {
        Pi::new(
            &Gains {
                proportional_a_k: 2.0,
                integral_s: 0.5,
            },
            6.0,
            Period::EveryTick,
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
}

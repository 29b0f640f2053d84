//! Temperature error to current: the plain loop.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::safety::Setpoint;
use thermal_settings::Gains;

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

impl Period {
    const fn ticks(self) -> u32 {
        match self {
            Self::EveryTick => 1,
            Self::TenthOfASecond => TICK_HZ / 10,
        }
    }
}

/// What a loop makes of an error, ready for the tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    /// A/K.
    proportional: i32,
    /// A per K and update.
    integral: i32,
    period: Period,
}

impl Response {
    /// `f64`; gains saturate at 32768 A/K and 2 A/K an update.
    #[must_use]
    pub fn new(gains: &Gains, period: Period) -> Self {
        let per_update = gains.proportional_a_k * f64::from(period.ticks())
            / (gains.integral_s * f64::from(TICK_HZ));
        Self {
            proportional: libm::ldexp(gains.proportional_a_k, GAIN_BITS as i32) as i32,
            integral: libm::ldexp(per_update, RATE_BITS as i32) as i32,
            period,
        }
    }
}

/// Proportional-integral law with limited output.
///
/// The integral stops while the output is at its limit and the error would drive it further, so there is
/// nothing to unwind afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pi {
    response: Response,
    limit: Current,
    /// Ticks until that.
    wait: u32,
    output: Current,
    /// Integral part of the output, A; never beyond the limit.
    state: i64,
}

impl Pi {
    /// At rest.
    #[must_use]
    pub const fn new(response: Response, limit: Current) -> Self {
        Self {
            response,
            limit,
            wait: 0,
            output: Current::ZERO,
            state: 0,
        }
    }

    /// Another response; the integral part of the output stays.
    pub const fn retune(&mut self, response: Response) {
        self.response = response;
    }

    /// Starts anew, from this current.
    pub fn restart(&mut self, current: Current) {
        (self.wait, self.output) = (0, current);
        self.state = i64::from(current.to_bits()) << (STATE_BITS - CURRENT_BITS);
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
            self.wait = self.response.period.ticks();
            self.output = self.respond(display.saturating_sub(setpoint.celsius()));
        }
        self.wait -= 1;
        self.output
    }

    /// Answer to an error that is positive when the display is too warm, whatever the period.
    pub fn respond(&mut self, error: Celsius) -> Current {
        let error = i64::from(error.to_bits());
        let proportional = (error * i64::from(self.response.proportional))
            >> (ERROR_BITS + GAIN_BITS - CURRENT_BITS);
        let state = self
            .state
            .saturating_add(error * i64::from(self.response.integral));
        let limit = i64::from(self.limit.to_bits());
        let wanted = proportional + (state >> (STATE_BITS - CURRENT_BITS));
        // Not `clamp`, which panics when its limits are the wrong way round.
        let output = wanted.min(limit).max(-limit);
        if output == wanted || (wanted > output) != (error > 0) {
            let limit = limit << (STATE_BITS - CURRENT_BITS);
            self.state = state.min(limit).max(-limit);
        }
        Current::from_bits(output as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pi() -> Pi {
        let gains = Gains {
            proportional_a_k: 2.0,
            integral_s: 0.5,
        };
        Pi::new(Response::new(&gains, Period::EveryTick), Current::lit("6"))
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
            let (a, b) = (
                up.update(setpoint, at(30.25)),
                down.update(setpoint, at(29.75)),
            );
            assert!((a + b).abs() <= Current::from_bits(4));
        }
    }
}

//! A proportional-integral controller from temperature error to current, with limited output and anti-windup.

use contact_model::fixed_point::Celsius;
use fixed::types::{I2F30, I12F52, I16F16};
use thermal_settings::Gains;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::safety::Setpoint;

/// Binary places that the integral has beyond those of a current, so that an error of 1 mK for one tick still counts.
const EXTRA_INTEGRAL_PLACES: u32 = I12F52::FRAC_NBITS - Current::FRAC_NBITS;

/// How often a proportional-integral controller takes the temperature error and changes its current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdatePeriod {
    /// At every control tick, 1000 times a second: the law `pi`, the observer's correction, and the identification of
    /// the tile.
    EveryTick,
    /// Ten times a second, as the display of the thesis: the law `pi-10hz`. The current is constant in between.
    TenthOfASecond,
}

impl UpdatePeriod {
    /// The period in ticks of 1 ms.
    const fn period_ticks(self) -> u32 {
        match self {
            Self::EveryTick => 1,
            Self::TenthOfASecond => TICK_HZ / 10,
        }
    }
}

/// Gains of a proportional-integral controller in fixed point, and how often it takes the error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PiCoefficients {
    /// Proportional gain, A/K.
    proportional: I16F16,
    /// Integral gain for one update, A/K.
    integral: I2F30,
    period: UpdatePeriod,
}

impl PiCoefficients {
    /// Converts gains from settings: proportional gain, A/K, and integral time, s. They saturate at 32768 A/K and 2 A/K
    /// per update. Computed in `f64`, so it is for start-up and the task that serves the host, not for the tick.
    #[must_use]
    pub fn new(gains: &Gains, period: UpdatePeriod) -> Self {
        let per_update = gains.proportional_a_k * f64::from(period.period_ticks())
            / (gains.integral_s * f64::from(TICK_HZ));
        let bits = |value: f64, places: u32| libm::ldexp(value, places as i32) as i32;
        Self {
            proportional: I16F16::from_bits(bits(gains.proportional_a_k, I16F16::FRAC_NBITS)),
            integral: I2F30::from_bits(bits(per_update, I2F30::FRAC_NBITS)),
            period,
        }
    }
}

/// A proportional-integral controller from temperature error, K, to current, A, with limited output.
///
/// Anti-windup: the integral stops while the output is at its limit and the error would drive it further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pi {
    coefficients: PiCoefficients,
    /// Largest magnitude of the output, A.
    limit: Current,
    /// Ticks of 1 ms until the next update; the output is constant until then.
    ticks_to_update: u32,
    /// Output of the last update, A; positive cools.
    output: Current,
    /// Integral part of the output, A; its magnitude never exceeds the limit.
    integral: I12F52,
}

impl Pi {
    /// A controller with output and integral 0 A, whose output never exceeds `limit`, A, in magnitude.
    #[must_use]
    pub const fn new(coefficients: PiCoefficients, limit: Current) -> Self {
        Self {
            coefficients,
            limit,
            ticks_to_update: 0,
            output: Current::ZERO,
            integral: I12F52::ZERO,
        }
    }

    /// Changes the gains; the integral part of the output, A, stays.
    pub const fn set_coefficients(&mut self, coefficients: PiCoefficients) {
        self.coefficients = coefficients;
    }

    /// Bumpless transfer: sets output and integral to the current, A, that something else has driven in this tick. The
    /// next update starts from there, whatever the error has been.
    pub fn track_current(&mut self, current: Current) {
        (self.ticks_to_update, self.output) = (0, current);
        self.integral = I12F52::from_bits(i64::from(current.to_bits()) << EXTRA_INTEGRAL_PLACES);
    }

    /// Largest magnitude of the output, A.
    #[must_use]
    pub const fn output_limit(&self) -> Current {
        self.limit
    }

    /// Current for one tick, A, positive cools: it rises while `display`, °C, is above the set-point. Between two
    /// updates of a slower [`UpdatePeriod`] it is the output of the last one.
    pub fn update_output(&mut self, setpoint: Setpoint, display: Celsius) -> Current {
        if self.ticks_to_update == 0 {
            self.ticks_to_update = self.coefficients.period.period_ticks();
            self.output = self.current_for_error(display.saturating_sub(setpoint.celsius()));
        }
        self.ticks_to_update -= 1;
        self.output
    }

    /// Current, A (positive cools), for an `error`, K, that is positive while the display is too warm. Integrates the
    /// error by one update, whatever the period.
    ///
    /// No sum overflows: the integral stays within 128 A (59 bits), its step within 2^10 A, the proportional part
    /// within 2^24 A of 38 bits.
    pub fn current_for_error(&mut self, error: Celsius) -> Current {
        let PiCoefficients {
            proportional,
            integral,
            ..
        } = self.coefficients;
        let proportional = error.wide_mul(proportional).to_bits()
            >> (Celsius::FRAC_NBITS + I16F16::FRAC_NBITS - Current::FRAC_NBITS);
        let sum = self.integral.saturating_add(error.wide_mul(integral));
        let limit = i64::from(self.limit.to_bits());
        let wanted = proportional + (sum.to_bits() >> EXTRA_INTEGRAL_PLACES);
        // Not `clamp`, which panics when its limits are the wrong way round.
        let output = wanted.min(limit).max(-limit);
        if output == wanted || (wanted > output) != (error > 0) {
            let limit = I12F52::from_bits(limit << EXTRA_INTEGRAL_PLACES);
            self.integral = sum.min(limit).max(-limit);
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
        Pi::new(
            PiCoefficients::new(&gains, UpdatePeriod::EveryTick),
            Current::lit("6"),
        )
    }

    fn at(t_c: f64) -> Celsius {
        Celsius::from_num(t_c)
    }

    #[test]
    fn a_constant_error_gives_kp_e_times_1_plus_t_over_ti() {
        let (setpoint, mut pi) = (Setpoint::limited(at(25.0)).0, pi());
        for tick in 1..=1000 {
            let expected = 2.0 * 0.5 * (1.0 + f64::from(tick) * 1e-3 / 0.5);
            let output = pi.update_output(setpoint, at(25.5)).to_num::<f64>();
            assert!(
                (output - expected).abs() < 1e-4,
                "tick {tick}: {output}, expected {expected}"
            );
        }
    }

    #[test]
    fn the_output_leaves_its_limit_as_soon_as_the_error_changes_sign() {
        let (setpoint, mut pi) = (Setpoint::limited(at(25.0)).0, pi());
        for _ in 0..10_000 {
            assert_eq!(pi.update_output(setpoint, at(40.0)), Current::lit("6"));
        }
        // Without anti-windup the integral would hold 600 A by now.
        let output = pi.update_output(setpoint, at(24.0));
        assert!(output <= Current::lit("4"), "{output}");
    }

    #[test]
    fn opposite_errors_give_opposite_currents() {
        let (setpoint, mut up, mut down) = (Setpoint::limited(at(30.0)).0, pi(), pi());
        for _ in 0..100 {
            let (a, b) = (
                up.update_output(setpoint, at(30.25)),
                down.update_output(setpoint, at(29.75)),
            );
            assert!((a + b).abs() <= Current::from_bits(4));
        }
    }
}

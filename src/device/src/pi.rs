//! A proportional-integral controller from temperature error to current, with limited output and anti-windup.

use contact_model::fixed_point::{Celsius, Word, truncated_units};
use fixed::types::{I2F30, I12F52, I16F16};
use thermal_settings::PiGains;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::safety::Setpoint;

/// Binary places that the integral has in addition to the 24 of a [`Current`]: 28, so that an error of 1 mK in one tick
/// still changes the integral.
const EXTRA_INTEGRAL_BINARY_PLACES: u32 = I12F52::FRAC_NBITS - Current::FRAC_NBITS;

/// How often a proportional-integral controller computes a new current from the temperature error: at every tick of 1
/// ms, or at every 100th. The integral gain is scaled to this period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdatePeriod {
    /// At every control tick, 1000 times a second: for the law `pi`, for the loop that corrects the model of the
    /// plate's observer, and for the loop that holds the display during an identification of the tile.
    EveryTick,
    /// At every 100th control tick, ten times a second, as in the display of the thesis (docs/thesis.md): for the law
    /// `pi-10hz`. The current is constant between two updates.
    TenthOfASecond,
}

impl UpdatePeriod {
    /// Ticks of 1 ms from one update to the next: 1 or 100.
    const fn period_ticks(self) -> u32 {
        match self {
            Self::EveryTick => 1,
            Self::TenthOfASecond => TICK_HZ / 10,
        }
    }
}

/// Gains of a proportional-integral controller in fixed point, and how often the controller computes a new current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PiCoefficients {
    /// Proportional gain: current for each kelvin of temperature error, A/K.
    proportional: I16F16,
    /// Integral gain: change of the current in one update for each kelvin of temperature error, A/K.
    integral: I2F30,
    period: UpdatePeriod,
}

impl PiCoefficients {
    /// Converts gains from the settings to fixed point: proportional gain, A/K, and integral time, s. The proportional
    /// gain saturates at 32768 A/K, the integral gain at 2 A/K per update, where their fixed-point types end. Computed
    /// in `f64`, so it is for start-up and the task that serves the host, not for the tick.
    pub const fn new(gains: &PiGains, period: UpdatePeriod) -> Self {
        let per_update = gains.proportional_a_k * period.period_ticks() as f64
            / (gains.integral_s * TICK_HZ as f64);
        Self {
            proportional: I16F16::from_bits(truncated_units(
                gains.proportional_a_k,
                I16F16::FRAC_NBITS,
            )),
            integral: I2F30::from_bits(truncated_units(per_update, I2F30::FRAC_NBITS)),
            period,
        }
    }
}

/// A proportional-integral controller from temperature error, K, to current, A, with limited output.
///
/// Anti-windup: the integral stops while the output is at its limit and the error would drive the output beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pi {
    coefficients: PiCoefficients,
    /// Largest magnitude of the controller's output and of its integral part, A.
    limit: Current,
    /// Ticks of 1 ms that are still to pass without an update, 0 to 99; the output stays constant in them. 0 if the
    /// next tick updates the output.
    ticks_to_update: u32,
    /// Output of the last update, or the current that [`Self::track_current`] has set since, A; positive cools.
    output: Current,
    /// Integral part of the output, A; positive cools. Its magnitude never exceeds `limit`.
    integral: I12F52,
}

/// A current with the binary places of the integral.
fn integral_of_current(current: Current) -> I12F52 {
    I12F52::from_bits(i64::from(current.to_bits()) << EXTRA_INTEGRAL_BINARY_PLACES)
}

impl Pi {
    /// A controller whose output and integral start at 0 A, and whose output never exceeds `limit`, A, in magnitude.
    pub const fn new(coefficients: PiCoefficients, limit: Current) -> Self {
        Self {
            coefficients,
            limit,
            ticks_to_update: 0,
            output: Current::ZERO,
            integral: I12F52::ZERO,
        }
    }

    /// Changes the gains and the update period; the output and its integral part, A, stay.
    pub const fn set_coefficients(&mut self, coefficients: PiCoefficients) {
        self.coefficients = coefficients;
    }

    /// Sets output and integral to `current`, A (positive cools), which this controller has not chosen: that of the
    /// self-test, of an identification or of another control law, or 0 A while the bridge is off or at a restart of the
    /// plate's observer. The next tick updates the output, starting from this current and not from errors of the past
    /// (bumpless transfer).
    pub fn track_current(&mut self, current: Current) {
        (self.ticks_to_update, self.output) = (0, current);
        self.integral = integral_of_current(current);
    }

    /// Largest magnitude of the current that the controller gives, A.
    pub const fn output_limit(&self) -> Current {
        self.limit
    }

    /// Runs the controller for one tick, and returns the current, A (positive cools), that is to bring the reading
    /// `display`, °C, to the set-point: the warmer the display, the larger the current. With the period
    /// [`UpdatePeriod::TenthOfASecond`] only every 100th tick changes the current.
    pub fn update_output_when_due(&mut self, setpoint: Setpoint, display: Celsius) -> Current {
        if self.ticks_to_update == 0 {
            self.ticks_to_update = self.coefficients.period.period_ticks();
            self.output = self.update_current_by_error(display.saturating_sub(setpoint.celsius()));
        }
        self.ticks_to_update -= 1;
        self.output
    }

    /// Runs one update for the temperature `error`, K (positive while the display is too warm): adds the error times
    /// the integral gain to the integral, and returns the current, A (positive cools): the sum of proportional part and
    /// integral, limited in magnitude. Every call is an update; [`Self::update_output_when_due`] calls this only when an update
    /// is due by the [`UpdatePeriod`].
    pub fn update_current_by_error(&mut self, error: Celsius) -> Current {
        // Nothing overflows 64 bits: with 52 binary places the integral is within 2^7 A and its step within 2^10 A;
        // with 38 binary places the proportional part is within 2^24 A.
        let PiCoefficients { proportional, integral, .. } = self.coefficients;
        let proportional = error.wide_mul(proportional).to_bits()
            >> (Celsius::FRAC_NBITS + I16F16::FRAC_NBITS - Current::FRAC_NBITS);
        let sum = self.integral.wrapping_add(error.wide_mul(integral));
        let integral = sum.to_bits() >> EXTRA_INTEGRAL_BINARY_PLACES;
        let wanted = Current::limited(proportional + integral);
        // Not `clamp`, which panics when its limits are the wrong way round.
        let output = wanted.min(self.limit).max(-self.limit);
        if output == wanted || (wanted > output) != (error > 0) {
            let integral = Current::limited(integral);
            let limited = integral.min(self.limit).max(-self.limit);
            // Keeps the fraction that the shift has dropped, except at the upper limit, which the fraction would exceed.
            self.integral = if limited == integral && limited < self.limit {
                sum
            } else {
                integral_of_current(limited)
            };
        }
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pi() -> Pi {
        let gains = PiGains { proportional_a_k: 2.0, integral_s: 0.5 };
        Pi::new(PiCoefficients::new(&gains, UpdatePeriod::EveryTick), Current::lit("6"))
    }

    fn at(t_c: f64) -> Celsius {
        Celsius::from_num(t_c)
    }

    #[test]
    fn a_constant_error_gives_kp_e_times_1_plus_t_over_ti() {
        let (setpoint, mut pi) = (Setpoint::clamp_celsius_with_flag(at(25.0)).0, pi());
        for tick in 1..=1000 {
            let expected = 2.0 * 0.5 * (1.0 + f64::from(tick) * 1e-3 / 0.5);
            let output = pi.update_output_when_due(setpoint, at(25.5)).to_num::<f64>();
            assert!((output - expected).abs() < 1e-4, "tick {tick}: {output}, expected {expected}");
        }
    }

    #[test]
    fn the_output_leaves_its_limit_as_soon_as_the_error_changes_sign() {
        let (setpoint, mut pi) = (Setpoint::clamp_celsius_with_flag(at(25.0)).0, pi());
        for _ in 0..10_000 {
            assert_eq!(pi.update_output_when_due(setpoint, at(40.0)), Current::lit("6"));
        }
        // Without anti-windup the integral would hold 600 A by now.
        let output = pi.update_output_when_due(setpoint, at(24.0));
        assert!(output <= Current::lit("4"), "{output}");
    }

    #[test]
    fn opposite_errors_give_opposite_currents() {
        let (setpoint, mut up, mut down) =
            (Setpoint::clamp_celsius_with_flag(at(30.0)).0, pi(), pi());
        for _ in 0..100 {
            let (a, b) = (
                up.update_output_when_due(setpoint, at(30.25)),
                down.update_output_when_due(setpoint, at(29.75)),
            );
            assert!((a + b).abs() <= Current::from_bits(4));
        }
    }
}

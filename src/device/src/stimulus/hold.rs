//! A set-point that moves to a temperature at a constant rate and stays there: the command `hold`.

use contact_model::fixed_point::Celsius;

use super::line::temperature_on_line;
use super::{Approach, STIMULUS_LEAD_TICKS, StimulusTemperatures};
use crate::TICK_HZ;
use crate::safety::Setpoint;
use crate::safety::limits::UNTUNED_RATE_MAX_K_S;

/// A running command `hold`: the set-point on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    start: Celsius,
    target: Celsius,
    /// Duration of the way, ticks.
    ticks: u32,
    /// Ticks of it that have passed.
    passed: u32,
    approach: Approach,
}

// A tile that was never identified accepts a `hold` without a rate.
const _: () = assert!(Hold::DEFAULT_RATE_K_S.to_bits() <= UNTUNED_RATE_MAX_K_S.to_bits());

impl Hold {
    /// Rate of `hold` without one, K/s. Slow enough for every law and thermistor, and for a tile that was never identified; the two
    /// display thermistors also agree closely enough for the detectors.
    pub const DEFAULT_RATE_K_S: Celsius = Celsius::ONE;

    /// Moves from `start`, °C, clamped to 15 to 42 °C, to `target` at this rate, K/s, above zero. The last tick may be
    /// slower, so that the rate is never exceeded.
    pub fn new(start: Celsius, target: Setpoint, rate_k_s: Celsius) -> Self {
        let start = Setpoint::clamp_celsius_with_flag(start).0.celsius();
        let target = target.celsius();
        let way = u64::from(target.abs_diff(start).to_bits()) * u64::from(TICK_HZ);
        let ticks = way.div_ceil(u64::from(rate_k_s.to_bits().max(1).unsigned_abs()));
        Self { start, target, ticks: ticks as u32, passed: 0, approach: Approach::to(target) }
    }

    /// Stays at this temperature, °C, which a display that is off it approaches.
    pub const fn at(celsius: Celsius) -> Self {
        Self {
            start: celsius,
            target: celsius,
            ticks: 0,
            passed: 0,
            approach: Approach::to(celsius),
        }
    }

    /// Moves on by one tick, and returns the temperatures of that tick for a display with this surface, °C.
    // A function of its own, so that the code of ticks without a hold stays together in the flash: 7 cycles of their mean.
    #[inline(never)]
    pub fn next_temperatures(&mut self, surface: Celsius) -> StimulusTemperatures {
        self.passed = self.ticks.min(self.passed.saturating_add(1));
        let at = |passed| temperature_on_line(self.start, self.target, passed, self.ticks);
        let now = at(self.passed);
        let target = if self.passed < self.ticks {
            at(self.passed.saturating_add(STIMULUS_LEAD_TICKS))
        } else {
            self.approach.next_target(surface, now)
        };
        StimulusTemperatures { now, target }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setpoint(celsius: f64) -> Setpoint {
        Setpoint::clamp_celsius_with_flag(Celsius::from_num(celsius)).0
    }

    #[test]
    fn the_set_point_moves_to_the_target_at_its_rate_and_stays() {
        for rate_k_s in [0.01, 0.1, 1.0, 5.0, 100.0] {
            for (from_c, target_c) in [(30.0, 42.0), (42.0, 15.0), (20.0, 20.0)] {
                let rate = Celsius::from_num(rate_k_s);
                let mut hold = Hold::new(Celsius::from_num(from_c), setpoint(target_c), rate);
                let way_k: f64 = target_c - from_c;
                let at = |tick: u32| {
                    let gone_k = (f64::from(tick) * 1e-3 * rate_k_s).min(way_k.abs());
                    from_c + gone_k * way_k.signum()
                };
                let ticks = (1e3 * way_k.abs() / rate_k_s) as u32 + 50;
                for tick in 1..ticks {
                    let temperatures = hold.next_temperatures(Celsius::from_num(at(tick)));
                    // The rate is rounded to 2^-22 K/s, and the duration up to a tick.
                    let rounding_k = 1e-6 + 1e-5 * way_k.abs() + 1.01e-3 * rate_k_s;
                    for (celsius, tick) in
                        [(temperatures.now, tick), (temperatures.target, tick + 14)]
                    {
                        let error_k = (celsius.to_num::<f64>() - at(tick)).abs();
                        assert!(error_k <= rounding_k, "{rate_k_s} {tick}: {error_k}");
                    }
                }
                let end = setpoint(target_c).celsius();
                assert_eq!(hold.next_temperatures(end).now, end);
            }
        }
    }

    #[test]
    fn the_end_of_a_course_is_approached_by_a_display_that_is_off_it() {
        let end = Celsius::lit("31");
        for (surface, target) in [("24", "24.5"), ("30.8", "31"), ("31", "31"), ("33", "32.5")] {
            let temperatures = Hold::at(end).next_temperatures(Celsius::lit(surface));
            let expected = StimulusTemperatures { now: end, target: Celsius::lit(target) };
            assert_eq!(temperatures, expected);
        }
    }

    #[test]
    fn a_start_outside_the_range_is_moved_to_the_nearest_set_point() {
        let mut hold = Hold::new(Celsius::lit("42.6"), Setpoint::MAX, Hold::DEFAULT_RATE_K_S);
        let first = hold.next_temperatures(Celsius::ZERO);
        assert_eq!(first.now, Setpoint::MAX.celsius());
        let mut hold = Hold::new(Celsius::lit("-20"), Setpoint::MAX, Hold::DEFAULT_RATE_K_S);
        let first = hold.next_temperatures(Celsius::ZERO);
        assert!(first.now < Celsius::lit("15.01"));
    }
}

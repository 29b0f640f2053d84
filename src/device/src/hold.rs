//! A display that is held at a temperature, as for calibration.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::safety::Setpoint;

/// How fast the set-point goes there, K/s. A plain loop overshoots by what it lags behind: on the slowest sensors by 0.7 K then, to
/// 42.7 °C, where a step from skin temperature takes it to 44 °C, which trips. Nor do thermistors of different lags part.
const RATE_K_S: u32 = 1;
/// The same, a tick.
const STEP: Celsius = Celsius::from_bits(((RATE_K_S << Celsius::FRAC_NBITS) / TICK_HZ) as i32);

/// Where a display is held, and how far its set-point has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    goal: Setpoint,
    setpoint: Setpoint,
}

impl Hold {
    /// Sets out for a temperature from the nearest set-point to what the display reads.
    #[must_use]
    pub fn new(goal: Setpoint, reading: Celsius) -> Self {
        let (setpoint, _) = Setpoint::limited(reading);
        Self { goal, setpoint }
    }

    /// The set-point of the next tick.
    pub fn step(&mut self) -> Setpoint {
        let now = self.setpoint.celsius();
        let missing = self.goal.celsius().saturating_sub(now);
        (self.setpoint, _) = Setpoint::limited(now.saturating_add(missing.clamp(-STEP, STEP)));
        self.setpoint
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_setpoint_goes_by_a_kelvin_a_second_to_its_goal_and_stays() {
        for (from_c, goal_c) in [(30.0, 42.0), (42.0, 15.0), (20.0, 20.0)] {
            let (goal, _) = Setpoint::limited(Celsius::from_num(goal_c));
            let mut hold = Hold::new(goal, Celsius::from_num(from_c));
            let way_k: f64 = goal_c - from_c;
            for tick in 1..60_000 {
                let gone_k = (f64::from(tick) * 1e-3).min(way_k.abs()) * way_k.signum();
                let setpoint_c = hold.step().celsius().to_num::<f64>();
                // The step is cut to 2^-22 K.
                let cut_k = f64::from(tick) * 2.4e-7;
                assert!(
                    (setpoint_c - (from_c + gone_k)).abs() <= cut_k,
                    "{setpoint_c} {tick}"
                );
            }
            assert_eq!(hold.step(), goal);
        }
    }

    #[test]
    fn a_reading_beyond_the_range_is_no_setpoint() {
        let mut hold = Hold::new(Setpoint::MAX, Celsius::lit("42.6"));
        assert_eq!(hold.step(), Setpoint::MAX);
        let mut hold = Hold::new(Setpoint::MAX, Celsius::lit("-20"));
        assert!(hold.step() < Setpoint::limited(Celsius::lit("15.01")).0);
    }
}

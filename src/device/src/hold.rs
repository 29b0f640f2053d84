//! A display that is held at a temperature, for example for a calibration.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::safety::Setpoint;

/// Slew rate of the set-point, K/s. A proportional-integral loop on the slowest thermistors overshoots by 0.7 K at this rate, to
/// 42.7 °C; a step from skin temperature would reach 44 °C and trip. Thermistors of different lags stay together, too.
const SLEW_RATE_K_S: u32 = 1;
/// Largest change of the set-point in one tick, K.
const STEP: Celsius = Celsius::from_bits(((SLEW_RATE_K_S << Celsius::FRAC_NBITS) / TICK_HZ) as i32);

/// The temperature at which a display is held, and the present set-point on the way there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    target: Setpoint,
    setpoint: Setpoint,
}

impl Hold {
    /// Starts at the set-point that is nearest to the display's reading.
    #[must_use]
    pub fn new(target: Setpoint, reading: Celsius) -> Self {
        let (setpoint, _) = Setpoint::limited(reading);
        Self { target, setpoint }
    }

    /// The set-point of the next tick.
    pub fn step(&mut self) -> Setpoint {
        let now = self.setpoint.celsius();
        let distance = self.target.celsius().saturating_sub(now);
        (self.setpoint, _) = Setpoint::limited(now.saturating_add(distance.clamp(-STEP, STEP)));
        self.setpoint
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_set_point_moves_to_the_target_by_1_k_per_second_and_stays() {
        for (from_c, target_c) in [(30.0, 42.0), (42.0, 15.0), (20.0, 20.0)] {
            let (target, _) = Setpoint::limited(Celsius::from_num(target_c));
            let mut hold = Hold::new(target, Celsius::from_num(from_c));
            let way_k: f64 = target_c - from_c;
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
            assert_eq!(hold.step(), target);
        }
    }

    #[test]
    fn a_reading_outside_the_range_starts_at_the_nearest_set_point() {
        let mut hold = Hold::new(Setpoint::MAX, Celsius::lit("42.6"));
        assert_eq!(hold.step(), Setpoint::MAX);
        let mut hold = Hold::new(Setpoint::MAX, Celsius::lit("-20"));
        assert!(hold.step() < Setpoint::limited(Celsius::lit("15.01")).0);
    }
}

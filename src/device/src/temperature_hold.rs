//! A display that is held at a temperature, for example for a calibration.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::safety::Setpoint;

/// Rate at which the set-point of the command `hold` moves to its target, K/s. At 1 K/s a proportional-integral loop on
/// the slowest thermistors overshoots a target of 42 °C by 0.7 K. A sudden step from skin temperature would lead to 44
/// °C and trip the station, whose limit is 43 °C. At 1 K/s the two display thermistors also agree closely enough for
/// the fault detectors, even with different lags.
const SETPOINT_SLEW_RATE_K_S: u32 = 1;
/// Largest change of the set-point of the command `hold` in one tick of 1 ms: 1 mK, rounded down to a multiple of 2^-22
/// K.
const SETPOINT_SLEW_PER_TICK: Celsius =
    Celsius::from_bits(((SETPOINT_SLEW_RATE_K_S << Celsius::FRAC_NBITS) / TICK_HZ) as i32);

/// A running command `hold`: the temperature that the host has chosen, and the set-point that moves there by 1 K/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemperatureHold {
    target: Setpoint,
    setpoint: Setpoint,
}

impl TemperatureHold {
    /// A hold whose set-point starts at `reading`, the display's temperature in °C, clamped to 15 to 42 °C, and moves
    /// to `target`. Created when the host sends `hold`.
    #[must_use]
    pub fn new(target: Setpoint, reading: Celsius) -> Self {
        let (setpoint, _) = Setpoint::clamp_celsius_with_flag(reading);
        Self { target, setpoint }
    }

    /// Moves the set-point by up to 1 mK toward the target temperature, and returns the new set-point; at the target it
    /// stays. To be called once in each tick of 1 ms.
    pub fn next_setpoint(&mut self) -> Setpoint {
        let now = self.setpoint.celsius();
        let distance = self.target.celsius().saturating_sub(now);
        (self.setpoint, _) = Setpoint::clamp_celsius_with_flag(
            now.saturating_add(distance.clamp(-SETPOINT_SLEW_PER_TICK, SETPOINT_SLEW_PER_TICK)),
        );
        self.setpoint
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_set_point_moves_to_the_target_by_1_k_per_second_and_stays() {
        for (from_c, target_c) in [(30.0, 42.0), (42.0, 15.0), (20.0, 20.0)] {
            let (target, _) = Setpoint::clamp_celsius_with_flag(Celsius::from_num(target_c));
            let mut hold = TemperatureHold::new(target, Celsius::from_num(from_c));
            let way_k: f64 = target_c - from_c;
            for tick in 1..60_000 {
                let gone_k = (f64::from(tick) * 1e-3).min(way_k.abs()) * way_k.signum();
                let setpoint_c = hold.next_setpoint().celsius().to_num::<f64>();
                // The step is cut to 2^-22 K.
                let cut_k = f64::from(tick) * 2.4e-7;
                assert!(
                    (setpoint_c - (from_c + gone_k)).abs() <= cut_k,
                    "{setpoint_c} {tick}"
                );
            }
            assert_eq!(hold.next_setpoint(), target);
        }
    }

    #[test]
    fn a_reading_outside_the_range_starts_at_the_nearest_set_point() {
        let mut hold = TemperatureHold::new(Setpoint::MAX, Celsius::lit("42.6"));
        assert_eq!(hold.next_setpoint(), Setpoint::MAX);
        let mut hold = TemperatureHold::new(Setpoint::MAX, Celsius::lit("-20"));
        assert!(hold.next_setpoint() < Setpoint::clamp_celsius_with_flag(Celsius::lit("15.01")).0);
    }
}

//! The PWM period of the bridges, and at which of its phases the sensors are sampled.
//!
//! What couples from a bridge into a sensor has the period of its PWM. The 16 conversions that a tick adds up must
//! therefore see 16 evenly spread phases of this period; if they all saw one phase, the coupling would be an offset that
//! depends on the duty. Scans are a whole number of steps apart, so the period is chosen such that they are almost a
//! sixteenth of a period more than whole periods apart.

/// Steps of the PWM timers in a second: their clock of 180 MHz.
pub const PWM_STEPS_PER_SECOND: u32 = 180_000_000;
/// PWM period with one finger, steps of 5.6 ns: 97.0 kHz. Scans are 11250 steps, 6.061 periods, apart.
pub const PWM_PERIOD_STEPS_OF_ONE_FINGER: u16 = 1856;
/// PWM period with five fingers, steps of 5.6 ns: 95.6 kHz. Scans are 2000 steps, 1.063 periods, apart.
pub const PWM_PERIOD_STEPS_OF_FIVE_FINGERS: u16 = 1882;

#[cfg(test)]
mod tests {
    use super::{PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER};
    use crate::sense::SCANS_PER_TICK;

    /// Steps from scan to scan, at 16 and at 90 kHz.
    const SCAN_STEPS: [f64; 2] = [11_250.0, 2000.0];

    /// Largest error of the mean of a tick's conversions, over duties and phases at its start, of a coupling of 1 from peak to
    /// peak: a square wave, as an edge of the bridge causes, or a triangle, as the ripple is.
    fn worst_error(period: f64, scan_steps: f64, is_square: bool) -> f64 {
        let mut worst = 0.0f64;
        for duty in (1..40).map(|part| f64::from(part) / 40.0) {
            for first in (0..64).map(|part| f64::from(part) / 64.0) {
                let coupled = |scan: usize| {
                    let phase = (first + scan as f64 * scan_steps / period).fract();
                    match (is_square, phase < duty) {
                        (true, high) => f64::from(u8::from(high)) - duty,
                        (false, true) => phase / duty - 0.5,
                        (false, false) => 0.5 - (phase - duty) / (1.0 - duty),
                    }
                };
                let sum: f64 = (0..SCANS_PER_TICK).map(coupled).sum();
                worst = worst.max((sum / SCANS_PER_TICK as f64).abs());
            }
        }
        worst
    }

    #[test]
    fn what_couples_from_the_bridge_averages_out_in_every_tick() {
        let periods = [PWM_PERIOD_STEPS_OF_ONE_FINGER, PWM_PERIOD_STEPS_OF_FIVE_FINGERS];
        for (period, scan_steps) in periods.into_iter().zip(SCAN_STEPS) {
            let period = f64::from(period);
            let square = worst_error(period, scan_steps, true);
            let triangle = worst_error(period, scan_steps, false);
            assert!(square < 0.08 && triangle < 0.03, "{square} {triangle}");
        }
        // Six periods exactly: every conversion sees the same phase.
        assert!(worst_error(1875.0, SCAN_STEPS[0], true) > 0.9);
        assert!(worst_error(1875.0, SCAN_STEPS[0], false) > 0.4);
    }
}

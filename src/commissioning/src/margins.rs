//! How far the loop on an identified tile is from oscillating.

use core::f64::consts::PI;

use thermal_device::TICK_HZ;
use thermal_settings::{Gains, Tile};

/// Phase and gain margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Phase that is left where the loop's gain is one, degrees.
    pub phase_deg: f64,
    /// Factor by which the gain could grow until no phase is left.
    pub gain: f64,
}

/// Angular frequencies between which both are looked for, rad/s: slower than any loop of settings, and what the ticks
/// can still follow.
const SLOWEST: f64 = 1e-6;
const FASTEST: f64 = PI * TICK_HZ as f64;
/// Halvings of the logarithm of that range: to a part in 10^9.
const HALVINGS: u32 = 34;

impl Margins {
    /// Of `Kc (1 + 1 / (Ti s)) gain / (s + leak) e^(-dead s) / (1 + lag s)`.
    ///
    /// The gain falls with frequency, and from the loop's integral time on there is phase left until there is none, so
    /// each crossing is found by halving. A tile so fast that phase is left at half of the ticks' rate is given the
    /// margin there.
    #[must_use]
    pub fn of(tile: &Tile, gains: &Gains) -> Self {
        let magnitude = |w: f64| {
            let loop_gain = gains.proportional_a_k * tile.gain_k_s_a;
            let integral = libm::hypot(1.0, 1.0 / (gains.integral_s * w));
            loop_gain * integral
                / (libm::hypot(w, tile.leak_1_s) * libm::hypot(1.0, tile.sensor_lag_s * w))
        };
        // Above the -180 degrees at which it oscillates.
        let left = |w: f64| {
            let lead = libm::atan(gains.integral_s * w) - 0.5 * PI;
            let plate = -libm::atan2(w, tile.leak_1_s);
            PI + lead + plate - libm::atan(tile.sensor_lag_s * w) - tile.dead_time_s * w
        };
        let crossing = halve(|w| magnitude(w) > 1.0, SLOWEST);
        // An integrator beside the plate leaves little phase at low frequencies: the crossing is above that of the gain.
        let turning = halve(|w| left(w) > 0.0, 1.0 / gains.integral_s);
        Self {
            phase_deg: left(crossing) * 180.0 / PI,
            gain: 1.0 / magnitude(turning),
        }
    }
}

/// The angular frequency from which on something is no longer so, rad/s.
fn halve(so: impl Fn(f64) -> bool, from: f64) -> f64 {
    let (mut low, mut high) = (libm::log(from), libm::log(FASTEST));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if so(libm::exp(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    libm::exp(0.5 * (low + high))
}

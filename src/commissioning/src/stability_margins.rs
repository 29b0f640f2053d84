//! Stability margins of the temperature loop on an identified tile.

use core::f64::consts::PI;

use thermal_device::TICK_HZ;
use thermal_settings::{Gains, Tile};

/// Phase margin and gain margin of a control loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityMargins {
    /// Phase margin: distance of the phase from -180° where the magnitude of the loop's gain is one, degrees.
    pub phase_deg: f64,
    /// Gain margin: factor by which the gain may grow until the loop is at the stability limit.
    pub gain: f64,
}

/// Lower end of the search, rad/s, slower than any loop of allowed settings.
const FREQUENCY_MIN: f64 = 1e-6;
/// Upper end of the search, rad/s, the Nyquist frequency of the ticks.
const FREQUENCY_MAX: f64 = PI * TICK_HZ as f64;
/// Bisection steps on the logarithm of the frequency; they determine it to one part in 10^9.
const BISECTIONS: u32 = 34;

impl StabilityMargins {
    /// Margins of the open loop
    /// `Kc (1 + 1 / (Ti s)) gain / (s + leak) e^(-dead_time s) / (1 + lag s)`.
    ///
    /// Its magnitude falls monotonically with frequency, and its phase crosses -180° once above `1 / Ti`, so bisection
    /// finds both crossings. If a tile is so fast that the phase stays above -180° up to the Nyquist frequency, the gain
    /// margin is that at the Nyquist frequency.
    #[must_use]
    pub fn new(tile: &Tile, gains: &Gains) -> Self {
        let magnitude = |w: f64| {
            let loop_gain = gains.proportional_a_k * tile.gain_k_s_a;
            let integral = libm::hypot(1.0, 1.0 / (gains.integral_s * w));
            loop_gain * integral
                / (libm::hypot(w, tile.leak_1_s) * libm::hypot(1.0, tile.sensor_lag_s * w))
        };
        // Phase above -180 degrees, rad.
        let phase = |w: f64| {
            let controller = libm::atan(gains.integral_s * w) - 0.5 * PI;
            let plate = -libm::atan2(w, tile.leak_1_s);
            PI + controller + plate - libm::atan(tile.sensor_lag_s * w) - tile.dead_time_s * w
        };
        let gain_crossover = bisect(|w| magnitude(w) > 1.0, FREQUENCY_MIN);
        // Below 1 / Ti the two integrators can bring the phase near -180 degrees, too.
        let phase_crossover = bisect(|w| phase(w) > 0.0, 1.0 / gains.integral_s);
        Self {
            phase_deg: phase(gain_crossover) * 180.0 / PI,
            gain: 1.0 / magnitude(phase_crossover),
        }
    }
}

/// The angular frequency, rad/s, from `from` on, above which a condition no longer holds.
fn bisect(holds: impl Fn(f64) -> bool, from: f64) -> f64 {
    let (mut low, mut high) = (libm::log(from), libm::log(FREQUENCY_MAX));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if holds(libm::exp(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    libm::exp(0.5 * (low + high))
}

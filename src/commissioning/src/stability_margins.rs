//! Stability margins of the temperature loop on an identified tile.

use core::f64::consts::PI;

use thermal_device::TICK_HZ;
use thermal_settings::{PiGains, Tile};

/// Phase margin and gain margin of the loop by which the law `pi` controls the display's temperature: how far the loop
/// is from instability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityMargins {
    /// Phase margin, degrees: phase of the open loop above -180° at the frequency at which the magnitude of its gain is
    /// one.
    pub phase_deg: f64,
    /// Gain margin: factor, without unit, by which the gain of the loop may grow until the loop becomes unstable.
    pub gain: f64,
}

/// Lower end of the search for the frequency at which the magnitude of the open loop's gain is one, rad/s. That
/// frequency is higher for all allowed settings.
const SEARCH_FREQUENCY_MIN_RAD_S: f64 = 1e-6;
/// Upper end of the search for frequencies of the open loop, rad/s: the Nyquist frequency of a loop that is closed at
/// every tick of 1 ms.
const SEARCH_FREQUENCY_MAX_RAD_S: f64 = PI * TICK_HZ as f64;
/// Number of bisections of the logarithm of the frequency. Between [`SEARCH_FREQUENCY_MIN_RAD_S`] and
/// [`SEARCH_FREQUENCY_MAX_RAD_S`], 34 bisections determine a frequency to about one part in 10^9.
const BISECTION_STEPS: u32 = 34;

impl StabilityMargins {
    /// Margins of the open loop
    /// `Kc (1 + 1 / (Ti s)) gain / (s + leak) e^(-dead_time s) / (1 + lag s)`,
    /// with the proportional gain `Kc` and the integral time `Ti` of `gains`, and the other parameters of `tile`.
    ///
    /// The magnitude of the open loop falls monotonically with frequency, and its phase crosses -180° once above `1 /
    /// Ti`, so bisection finds both crossings. If a tile is so fast that the phase stays above -180° up to the Nyquist
    /// frequency, the gain margin is that at the Nyquist frequency.
    pub fn new(tile: &Tile, gains: &PiGains) -> Self {
        let magnitude = |w: f64| {
            let loop_gain = gains.proportional_a_k * tile.gain_k_s_a;
            let squares = |a: f64, b: f64| a * a + b * b;
            let integral = squares(1.0, 1.0 / (gains.integral_s * w));
            let plate = squares(w, tile.leak_1_s) * squares(1.0, tile.sensor_lag_s * w);
            loop_gain * libm::sqrt(integral / plate)
        };
        // Phase above -180 degrees, rad.
        let phase = |w: f64| {
            let controller = libm::atan(gains.integral_s * w) - 0.5 * PI;
            let plate = -libm::atan(w / tile.leak_1_s);
            PI + controller + plate - libm::atan(tile.sensor_lag_s * w) - tile.dead_time_s * w
        };
        let gain_crossover = bisect_frequency(|w| magnitude(w) > 1.0, SEARCH_FREQUENCY_MIN_RAD_S);
        // Below 1 / Ti the two integrators can bring the phase near -180 degrees, too.
        let phase_crossover = bisect_frequency(|w| phase(w) > 0.0, 1.0 / gains.integral_s);
        Self {
            phase_deg: phase(gain_crossover) * 180.0 / PI,
            gain: 1.0 / magnitude(phase_crossover),
        }
    }
}

/// The angular frequency, rad/s, between `from` and the Nyquist frequency, up to which the condition `holds` is true
/// and above which it is false; found by bisection.
fn bisect_frequency(holds: impl Fn(f64) -> bool, from: f64) -> f64 {
    let (mut low, mut high) = (libm::log(from), libm::log(SEARCH_FREQUENCY_MAX_RAD_S));
    for _ in 0..BISECTION_STEPS {
        let middle = 0.5 * (low + high);
        if holds(libm::exp(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    libm::exp(0.5 * (low + high))
}

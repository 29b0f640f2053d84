//! Parameters of the tile, and the controller gains that follow from them.

use super::{PiGains, TICK_S, round_to_decimals};

/// Thermal dynamics of the tile, the Peltier module with its display plate: how the module's demanded current `I`, A,
/// positive if it cools, changes the plate's temperature `T`, K, and the reading `y`, K, of the thermistor in the
/// plate. `T` and `y` are deviations from a steady state; `t` is the time, s.
///
/// ```text
/// dT/dt = -gain (I - joule I^2) - leak T      with I at the time t - dead_time
/// lag dy/dt = T - y
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Rate at which the plate cools per ampere of cooling current, K/s per A, without Joule heating and leak;
    /// positive.
    pub gain_k_s_a: f64,
    /// Joule heating of the module relative to its cooling, 1/A: a cooling current `I` cools as much as the current
    /// `I - joule_per_a I^2` would without Joule heating.
    pub joule_per_a: f64,
    /// Rate, 1/s, at which the plate's deviation from its steady temperature decays through heat flow from and to the
    /// sink.
    pub leak_1_s: f64,
    /// Time constant, s, with which the reading of the display's thermistor follows the temperature of the plate.
    pub sensor_lag_s: f64,
    /// Dead time, s: delay from a change of the demanded current to the first response of the plate's temperature.
    pub dead_time_s: f64,
}

impl Tile {
    /// Nominal tile, the factory default: a Peltier module of 30 mm and 6 A with a thermistor in its display plate. Its
    /// parameters were identified on the simulated device, by `cargo hil-sim commission scenes/copper.toml`.
    pub const FACTORY_DEFAULT: Self = Self {
        gain_k_s_a: 2.957,
        joule_per_a: 0.0585,
        leak_1_s: 0.103,
        sensor_lag_s: 0.1,
        dead_time_s: 0.016,
    };

    /// Whether it was identified: whether it is another one than the factory's.
    pub fn is_identified(&self) -> bool {
        *self != Self::FACTORY_DEFAULT
    }

    /// Number of decimals, 6, of each of the tile's parameters in a `set tile` line and in the record in flash.
    /// Parameters are rounded to it, so that line and record hold them exactly.
    pub const DECIMALS: i32 = 6;

    /// Gain (K/s per A), Joule term (1/A), leak (1/s), sensor lag (s) and dead time (s), in the order in which a
    /// `set tile` line and the record in flash hold them.
    pub const fn to_array(&self) -> [f64; 5] {
        [self.gain_k_s_a, self.joule_per_a, self.leak_1_s, self.sensor_lag_s, self.dead_time_s]
    }

    /// A tile with this gain (K/s per A), Joule term (1/A), leak (1/s), sensor lag (s) and dead time (s), each rounded
    /// to [`Self::DECIMALS`].
    pub fn from_array_rounded(values: [f64; 5]) -> Self {
        let [gain_k_s_a, joule_per_a, leak_1_s, sensor_lag_s, dead_time_s] =
            values.map(|value| round_to_decimals(value, Self::DECIMALS));
        Self { gain_k_s_a, joule_per_a, leak_1_s, sensor_lag_s, dead_time_s }
    }
}

impl PiGains {
    /// Gains for a tile by the SIMC tuning rule for an integrating process (Skogestad 2003). The proportional gain is
    /// `1 / (gain (tauc + theta))`, A/K, the integral time `4 (tauc + theta)`, s, with the tile's gain, K/s per A, and
    /// the time constant of the closed loop `tauc = theta`. The effective dead time `theta`, s, is the sum of the
    /// sensor's lag, the tile's dead time and half of `hold_s`, the time in seconds between two updates of the current.
    pub fn simc_for_update_interval(tile: &Tile, hold_s: f64) -> Self {
        let theta_s = tile.sensor_lag_s + tile.dead_time_s + 0.5 * hold_s;
        let closed_s = 2.0 * theta_s;
        Self { proportional_a_k: 1.0 / (tile.gain_k_s_a * closed_s), integral_s: 4.0 * closed_s }
    }

    /// Gains for a tile, first those of the control law `pi`, which updates the module's current every 1 ms, then those
    /// of the law `pi-10hz`, which updates it every 100 ms.
    pub fn for_1khz_and_10hz_laws(tile: &Tile) -> [Self; 2] {
        [TICK_S, 0.1].map(|hold_s| Self::simc_for_update_interval(tile, hold_s))
    }
}

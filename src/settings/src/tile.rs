//! Parameters of the tile, and the controller gains that follow from them.

use super::{Gains, TICK_HZ, round_to_decimals};

/// Dynamics of the tile, the Peltier module with its display plate: from the demanded current `I` to the display's
/// reading `y`, as deviations from a steady state.
///
/// ```text
/// dT/dt = -gain (I - joule I^2)(t - dead time) - leak T      plate; positive I cools
/// lag dy/dt = T - y                                          sensor
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Rate of change of the plate's temperature per current, K/s per A.
    pub gain_k_s_a: f64,
    /// Part of the cooling that Joule heating cancels, per current, 1/A.
    pub joule_per_a: f64,
    /// Rate at which the plate relaxes towards the sink, 1/s.
    pub leak_1_s: f64,
    /// Time constant of the display's thermistor, s.
    pub sensor_lag_s: f64,
    /// Dead time from a demanded current to the surface of the plate, s.
    pub dead_time_s: f64,
}

impl Tile {
    /// Nominal tile: a 30 mm, 6 A module with a thermistor in its display plate, as identified by
    /// `cargo hil-sim commission scenes/copper.toml`.
    pub const CLASS: Self = Self {
        gain_k_s_a: 2.91,
        joule_per_a: 0.0585,
        leak_1_s: 0.103,
        sensor_lag_s: 0.1,
        dead_time_s: 0.016,
    };

    /// Decimals of a stored parameter. Values are rounded to them, so that text and record hold them exactly.
    pub const DECIMALS: usize = 6;

    /// Gain, Joule term, leak, lag and dead time, in their order on a line of text.
    #[must_use]
    pub const fn to_array(&self) -> [f64; 5] {
        [
            self.gain_k_s_a,
            self.joule_per_a,
            self.leak_1_s,
            self.sensor_lag_s,
            self.dead_time_s,
        ]
    }

    /// The inverse of [`Self::to_array`], rounded to the decimals that are stored.
    #[must_use]
    pub fn from_array(values: [f64; 5]) -> Self {
        let [gain_k_s_a, joule_per_a, leak_1_s, sensor_lag_s, dead_time_s] =
            values.map(|value| round_to_decimals(value, Self::DECIMALS as i32));
        Self {
            gain_k_s_a,
            joule_per_a,
            leak_1_s,
            sensor_lag_s,
            dead_time_s,
        }
    }
}

impl Gains {
    /// Gains by the SIMC rule for an integrating process (Skogestad 2003): `Kc = 1 / (k (tauc + theta))` and
    /// `Ti = 4 (tauc + theta)` with `tauc = theta`. The effective dead time `theta` is the sum of the sensor's lag, the
    /// tile's dead time and half of `hold_s`, the time for which each current is held, s.
    #[must_use]
    pub fn simc(tile: &Tile, hold_s: f64) -> Self {
        let theta_s = tile.sensor_lag_s + tile.dead_time_s + 0.5 * hold_s;
        let closed_s = 2.0 * theta_s;
        Self {
            proportional_a_k: 1.0 / (tile.gain_k_s_a * closed_s),
            integral_s: 4.0 * closed_s,
        }
    }

    /// Gains of the loop that is closed at every tick, and of the loop that is closed ten times a second.
    #[must_use]
    pub fn for_both_loop_rates(tile: &Tile) -> [Self; 2] {
        [1.0 / f64::from(TICK_HZ), 0.1].map(|hold_s| Self::simc(tile, hold_s))
    }
}

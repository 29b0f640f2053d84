//! What tuning finds out about the tile, and the gains that follow from it.

use super::{Gains, rounded};
use crate::TICK_HZ;

/// The tile from the current asked for to the display's reading, in deviations from a state of rest:
///
/// ```text
/// dT/dt = -gain (I - joule I^2)(t - dead time) - leak T      plate; positive I cools
/// lag dy/dt = T - y                                          sensor
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Slope of the plate's temperature per current, K/s per A.
    pub gain_k_s_a: f64,
    /// Loss of that per current: what Joule's heat takes away, 1/A.
    pub joule_per_a: f64,
    /// Rate at which the plate relaxes towards the sink, 1/s.
    pub leak_1_s: f64,
    /// Lag of the display's thermistor, s.
    pub sensor_lag_s: f64,
    /// From a current that is asked for to the plate's surface, s.
    pub dead_time_s: f64,
}

impl Tile {
    /// A 30 mm, 6 A module with a thermistor in its display plate, as tuning finds it (`cargo hil-sim commission
    /// scenes/copper.toml`).
    pub const CLASS: Self = Self {
        gain_k_s_a: 2.91,
        joule_per_a: 0.0585,
        leak_1_s: 0.103,
        sensor_lag_s: 0.1,
        dead_time_s: 0.016,
    };

    /// Decimals that are kept, so that a line of text holds all of it.
    pub const DECIMALS: usize = 6;

    /// Gain, Joule's term, leak, lag and dead time, as lines have them.
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

    /// From what [`Self::to_array`] gives, with the decimals that are kept.
    #[must_use]
    pub fn from_array(values: [f64; 5]) -> Self {
        let [gain_k_s_a, joule_per_a, leak_1_s, sensor_lag_s, dead_time_s] =
            values.map(|value| rounded(value, Self::DECIMALS as i32));
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
    /// The SIMC rule for an integrating process (Skogestad 2003): `Kc = 1 / (k (tauc + theta))` and
    /// `Ti = 4 (tauc + theta)` with `tauc = theta`. All that delays counts as dead time: the sensor's lag, the tile's
    /// dead time, and half of the time for which a current is held.
    #[must_use]
    pub fn simc(tile: &Tile, held_s: f64) -> Self {
        let theta_s = tile.sensor_lag_s + tile.dead_time_s + 0.5 * held_s;
        let closed_s = 2.0 * theta_s;
        Self {
            proportional_a_k: 1.0 / (tile.gain_k_s_a * closed_s),
            integral_s: 4.0 * closed_s,
        }
    }

    /// The gains of the loop at every tick, and of that ten times a second.
    #[must_use]
    pub fn of_tile(tile: &Tile) -> [Self; 2] {
        [1.0 / f64::from(TICK_HZ), 0.1].map(|held_s| Self::simc(tile, held_s))
    }
}

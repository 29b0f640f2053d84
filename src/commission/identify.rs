//! From the sums of an experiment to the tile.

use super::experiment::{Row, UNKNOWNS};
use super::solve::solve;
use crate::TICK_HZ;
use crate::settings::Tile;

/// Seconds of 1024 ticks.
const UNIT_S: f64 = 1024.0 / TICK_HZ as f64;

/// The tile that fits best; `None` if the sums belong to none.
#[must_use]
pub fn identify(rows: &[Row; UNKNOWNS]) -> Option<Tile> {
    let mut normal = rows.map(|row| core::array::from_fn(|i| row[i] as f64));
    let mut right = rows.map(|row| row[UNKNOWNS] as f64);
    solve(&mut normal, &mut right, UNKNOWNS)?;
    let [y, u2, u1, v2, y2, ..] = right;
    let (lag, gain, gain_dead, gain_joule, leak) = (-y * UNIT_S, -u2 / UNIT_S, u1, v2 / UNIT_S, -y2 / UNIT_S);
    // All of them were divided by m = 1 + leak lag.
    let mut m = 1.0;
    for _ in 0..8 {
        m = 1.0 + leak * lag * m * m;
    }
    let tile = Tile::from_array([
        gain * m,
        gain_joule / gain,
        leak * m,
        lag * m,
        gain_dead / gain,
    ]);
    Some(tile)
}

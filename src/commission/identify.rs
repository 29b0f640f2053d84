//! From the sums of an experiment to the tile.

use super::experiment::{ROWS, Row, UNIT_BITS, UNKNOWNS};
use super::request::TILE;
use super::solve::solve;
use crate::TICK_HZ;
use crate::settings::Tile;

/// The equations' unit of time, s.
const UNIT_S: f64 = (1 << UNIT_BITS) as f64 / TICK_HZ as f64;
/// A current that is asked for flows a tick later.
const ASKED_S: f64 = 1.0 / TICK_HZ as f64;
/// Dead time of plates of this class, s. A sensor's lag of as little looks almost the same, so only the sum of both is
/// certain; this is what is likely, and so it counts as much as so many parts of 2^22 in each equation.
const LIKELY_S: f64 = 0.0145;
const WEIGHT: f64 = 1e14;

/// Places of the unknowns.
const LAG: usize = 0;
const GAIN: usize = 1;
const GAIN_DEAD: usize = 2;
const GAIN_JOULE: usize = 3;
const LEAK: usize = 4;

/// The tile that fits best; `None` if the sums belong to none within the limits of settings.
#[must_use]
pub fn identify(rows: &[Row; ROWS]) -> Option<Tile> {
    let [.., [asked_asked, asked_measured, ..]] = rows;
    let measured_per_asked = *asked_measured as f64 / *asked_asked as f64;
    // First with any dead time, to know the gain; then with what is likely of it.
    let free = fit(rows, 0.0, 0.0)?;
    let likely = fit(rows, WEIGHT, -free[GAIN] / UNIT_S * LIKELY_S)?;
    let (lag, gain, leak) = (
        -likely[LAG] * UNIT_S,
        -likely[GAIN] / UNIT_S,
        -likely[LEAK] / UNIT_S,
    );
    // All of them were divided by m = 1 + leak lag.
    let mut m = 1.0;
    for _ in 0..8 {
        m = 1.0 + leak * lag * m * m;
    }
    let tile = Tile::from_array([
        gain * m * measured_per_asked,
        likely[GAIN_JOULE] / UNIT_S / gain * measured_per_asked,
        leak * m,
        lag * m,
        likely[GAIN_DEAD] / gain + ASKED_S,
    ]);
    let within =
        |(value, allowed): (f64, &crate::protocol::Number)| (allowed.min..=allowed.max).contains(&value);
    tile.to_array().into_iter().zip(&TILE).all(within).then_some(tile)
}

/// Least squares, with a weight on a value of gain times dead time.
fn fit(rows: &[Row; ROWS], weight: f64, gain_dead: f64) -> Option<[f64; UNKNOWNS]> {
    let mut normal: [[f64; UNKNOWNS]; UNKNOWNS] =
        core::array::from_fn(|i| core::array::from_fn(|j| rows[i][j] as f64));
    let mut right: [f64; UNKNOWNS] = core::array::from_fn(|i| rows[i][UNKNOWNS] as f64);
    normal[GAIN_DEAD][GAIN_DEAD] += weight;
    right[GAIN_DEAD] += weight * gain_dead;
    solve(&mut normal, &mut right, UNKNOWNS)?;
    Some(right)
}

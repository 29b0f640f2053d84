//! From the sums of an experiment to the tile.

use core::ops::RangeInclusive;

use super::solve::solve;
use thermal_device::TICK_HZ;
use thermal_device::identification::{ROWS, Row, Totals, UNIT_BITS, UNKNOWNS};
use thermal_settings::Tile;
use thermal_settings::{Range, TILE_RANGES};

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
const ZERO: usize = 7;

/// Current at which asked for and measured are compared, A in 2^-16: the bridge's dead times take the same of any current, which is
/// much of a small one, and the display goes far by large ones.
const LARGE: f64 = 4.5 * AMPERE;
/// An ampere in what was compared.
const AMPERE: f64 = 65_536.0;

/// Parts of the current asked for that a sound bridge and mirror measure.
const CURRENT: RangeInclusive<f64> = 0.5..=1.5;
/// Dead times that a plate of this class can have. What disturbs the display ends up there first.
static DEAD: Range = Range {
    name: "dead time",
    unit: "s",
    min: 0.004,
    max: 0.04,
};
/// Largest part of the movement, integrated and RMS, that the tile may leave unexplained; a converter's steps leave 0.7 %.
const UNEXPLAINED: f64 = 0.02;

/// Why sums belong to no tile.
#[derive(Clone, Debug, PartialEq)]
pub enum NoTile {
    /// Measured current, as a part of what was asked for.
    Current(f64),
    /// The display did not answer the current.
    Nothing,
    /// The display did not move as a tile does: part of its movement that is left over.
    Unlike(f64),
    /// A value beyond the limits of settings.
    Beyond(&'static Range, f64),
}

/// The tile that fits best.
///
/// # Errors
/// The sums belong to no tile within the limits of settings.
pub fn identify(rows: &[Row; ROWS]) -> Result<Tile, NoTile> {
    let [.., totals] = rows;
    let total = |place: Totals| totals[place as usize] as f64;
    let measured_per_asked = part_measured(total, 0.0);
    if !CURRENT.contains(&measured_per_asked) {
        return Err(NoTile::Current(measured_per_asked));
    }
    // First with any dead time, to know the gain; then with what is likely of it.
    let free = fit(rows, 0.0, 0.0).ok_or(NoTile::Nothing)?;
    let likely = fit(rows, WEIGHT, -free[GAIN] / UNIT_S * LIKELY_S).ok_or(NoTile::Nothing)?;
    let left = unexplained(rows, &likely, total(Totals::Made));
    if left.is_nan() || left > UNEXPLAINED {
        return Err(NoTile::Unlike(left));
    }
    let flows_per_asked = part_measured(total, -likely[ZERO] / likely[GAIN]);
    let (lag, gain, leak) = (
        -likely[LAG] * UNIT_S,
        -likely[GAIN] / UNIT_S,
        -likely[LEAK] / UNIT_S,
    );
    // All of them were divided by m = 1 + leak lag, so m is a root of m = 1 + (leak / m) (lag / m) m^2.
    let m = 2.0 / (1.0 + libm::sqrt((1.0 - 4.0 * leak * lag).max(0.0)));
    let tile = Tile::from_array([
        gain * m * flows_per_asked,
        likely[GAIN_JOULE] / UNIT_S / gain * flows_per_asked,
        leak * m,
        lag * m,
        likely[GAIN_DEAD] / gain + ASKED_S,
    ]);
    let values = tile.to_array().into_iter().zip(&TILE_RANGES);
    let beyond = |(value, allowed): &(f64, &Range)| !(allowed.min..=allowed.max).contains(value);
    match values.chain([(tile.dead_time_s, &DEAD)]).find(beyond) {
        Some((value, allowed)) => Err(NoTile::Beyond(allowed, value)),
        None => Ok(tile),
    }
}

/// What is measured of a large current that is asked for, by the line through what was compared, less the mirror's zero, A.
fn part_measured(total: impl Fn(Totals) -> f64, zero_a: f64) -> f64 {
    let (ticks, asked, measured) = (
        total(Totals::Ticks),
        total(Totals::Asked),
        total(Totals::Measured),
    );
    let slope = (ticks * total(Totals::AskedMeasured) - asked * measured)
        / (ticks * total(Totals::AskedSquared) - asked * asked);
    let at_none = (measured - slope * asked) / ticks;
    slope + (at_none - zero_a * AMPERE) / LARGE
}

/// Root of the mean square that a fit leaves, as a part of that of what it explains.
fn unexplained(rows: &[Row; ROWS], fitted: &[f64; UNKNOWNS], made: f64) -> f64 {
    let left: f64 = made
        + rows.iter().zip(fitted).fold(0.0, |sum, (row, x)| {
            let explained: f64 = row.iter().zip(fitted).map(|(a, y)| *a as f64 * y).sum();
            sum + x * (explained - 2.0 * row[UNKNOWNS] as f64)
        });
    libm::sqrt(left.max(0.0) / made)
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

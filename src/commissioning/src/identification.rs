//! Parameter identification: the tile's parameters from the normal equations that the station accumulated during its
//! current pulses, by least squares.

use core::ops::RangeInclusive;

use super::cholesky::solve;
use thermal_device::TICK_HZ;
use thermal_device::identification::{
    NormalEquationRow, ROWS, Statistic, TIME_UNIT_SHIFT, UNKNOWNS,
};
use thermal_settings::{Range, Tile};

/// Unit of time of the equations, s.
const UNIT_S: f64 = (1 << TIME_UNIT_SHIFT) as f64 / TICK_HZ as f64;
/// Delay from a demanded current to its flow, one tick, s; the equations count the dead time from the flow.
const ACTUATION_DELAY_S: f64 = 1.0 / TICK_HZ as f64;
/// Prior value of the dead time of plates of this class, s. The response hardly distinguishes a dead time from an
/// equally short lag of the sensor; only their sum is observable, so a prior has to divide it.
const DEAD_TIME_PRIOR_S: f64 = 0.0145;
/// Weight of this prior in the normal equations, whose coefficients are in units of 2^-44.
const DEAD_TIME_PRIOR_WEIGHT: f64 = 1e14;

/// Indices of the unknowns in the equation of [`thermal_device::identification`], where their signs stand; each is divided
/// by `1 + leak lag`. The unknowns without an index here are nuisance parameters.
const LAG: usize = 0;
const GAIN: usize = 1;
const GAIN_DEAD_TIME: usize = 2;
const GAIN_JOULE: usize = 3;
const LEAK: usize = 4;
const GAIN_MIRROR_ZERO: usize = 7;

/// One ampere in the unit of the current comparison.
const AMPERE: f64 = 65_536.0;
/// Current at which demanded and measured current are compared, 4.5 A. The dead times of the bridge take the same from
/// any current, which is a large part of a small one; large currents move the display most.
const COMPARISON_CURRENT: f64 = 4.5 * AMPERE;

/// Plausible ratios of measured to demanded current.
const CURRENT_RATIOS: RangeInclusive<f64> = 0.5..=1.5;
/// Plausible dead times of plates of this class. A disturbance of the display distorts this parameter first.
static PLAUSIBLE_DEAD_TIME: Range = Range {
    name: "dead time",
    unit: "s",
    min: 0.004,
    max: 0.04,
};
/// Largest RMS residual of the integrated response, as a fraction of the response; quantisation by the converter leaves
/// 0.007.
const RESIDUAL_MAX: f64 = 0.02;

/// Why the response to the pulses is not that of a tile.
#[derive(Clone, Debug, PartialEq)]
pub enum IdentificationError {
    /// The ratio of measured to demanded current is implausible.
    CurrentRatio(f64),
    /// The display did not respond to the current.
    NoResponse,
    /// The model does not explain the response: RMS residual as a fraction of the response.
    ModelMismatch(f64),
    /// A parameter lies outside its range.
    OutOfRange(&'static Range, f64),
}

/// The tile whose response fits best.
///
/// # Errors
/// The response is not that of a tile, or a parameter lies outside its range.
pub fn identify(rows: &[NormalEquationRow; ROWS]) -> Result<Tile, IdentificationError> {
    let [.., totals] = rows;
    let total = |place: Statistic| totals[place as usize] as f64;
    let measured_ratio = current_ratio(total, 0.0);
    if !CURRENT_RATIOS.contains(&measured_ratio) {
        return Err(IdentificationError::CurrentRatio(measured_ratio));
    }
    // The prior is one of gain times dead time, so a fit without it determines the gain first.
    let without_prior = fit(rows, 0.0, 0.0).ok_or(IdentificationError::NoResponse)?;
    let gain_dead_time_prior = -without_prior[GAIN] / UNIT_S * DEAD_TIME_PRIOR_S;
    let fitted = fit(rows, DEAD_TIME_PRIOR_WEIGHT, gain_dead_time_prior)
        .ok_or(IdentificationError::NoResponse)?;
    let residual = relative_residual(rows, &fitted, total(Statistic::SquaredRegressand));
    if residual.is_nan() || residual > RESIDUAL_MAX {
        return Err(IdentificationError::ModelMismatch(residual));
    }
    let flowing_ratio = current_ratio(total, -fitted[GAIN_MIRROR_ZERO] / fitted[GAIN]);
    let (lag, gain, leak) = (
        -fitted[LAG] * UNIT_S,
        -fitted[GAIN] / UNIT_S,
        -fitted[LEAK] / UNIT_S,
    );
    // All unknowns are divided by m = 1 + leak lag, so m is a root of m = 1 + (leak / m) (lag / m) m^2.
    let m = 2.0 / (1.0 + libm::sqrt((1.0 - 4.0 * leak * lag).max(0.0)));
    let tile = Tile::from_array([
        gain * m * flowing_ratio,
        fitted[GAIN_JOULE] / UNIT_S / gain * flowing_ratio,
        leak * m,
        lag * m,
        fitted[GAIN_DEAD_TIME] / gain + ACTUATION_DELAY_S,
    ]);
    let implausible_dead_time = (!PLAUSIBLE_DEAD_TIME.contains(tile.dead_time_s))
        .then_some((&PLAUSIBLE_DEAD_TIME, tile.dead_time_s));
    match tile.out_of_range().or(implausible_dead_time) {
        Some((allowed, value)) => Err(IdentificationError::OutOfRange(allowed, value)),
        None => Ok(tile),
    }
}

/// Ratio of measured to demanded current at [`COMPARISON_CURRENT`], by linear regression of all compared currents; the
/// zero error of the mirror, A, is subtracted.
fn current_ratio(total: impl Fn(Statistic) -> f64, mirror_zero_a: f64) -> f64 {
    let (ticks, demanded, measured) = (
        total(Statistic::ComparedTicks),
        total(Statistic::Demanded),
        total(Statistic::Measured),
    );
    let slope = (ticks * total(Statistic::DemandedTimesMeasured) - demanded * measured)
        / (ticks * total(Statistic::SquaredDemanded) - demanded * demanded);
    let intercept = (measured - slope * demanded) / ticks;
    slope + (intercept - mirror_zero_a * AMPERE) / COMPARISON_CURRENT
}

/// RMS residual of a fit as a fraction of the response, whose sum of squares is `response_squared`.
fn relative_residual(
    rows: &[NormalEquationRow; ROWS],
    fitted: &[f64; UNKNOWNS],
    response_squared: f64,
) -> f64 {
    let residual_squared: f64 = response_squared
        + rows.iter().zip(fitted).fold(0.0, |sum, (row, x)| {
            let explained: f64 = row.iter().zip(fitted).map(|(a, y)| *a as f64 * y).sum();
            sum + x * (explained - 2.0 * row[UNKNOWNS] as f64)
        });
    libm::sqrt(residual_squared.max(0.0) / response_squared)
}

/// Solves the normal equations with a weighted prior of gain times dead time.
fn fit(
    rows: &[NormalEquationRow; ROWS],
    prior_weight: f64,
    gain_dead_time: f64,
) -> Option<[f64; UNKNOWNS]> {
    let mut matrix: [[f64; UNKNOWNS]; UNKNOWNS] =
        core::array::from_fn(|i| core::array::from_fn(|j| rows[i][j] as f64));
    let mut solution: [f64; UNKNOWNS] = core::array::from_fn(|i| rows[i][UNKNOWNS] as f64);
    matrix[GAIN_DEAD_TIME][GAIN_DEAD_TIME] += prior_weight;
    solution[GAIN_DEAD_TIME] += prior_weight * gain_dead_time;
    solve(&mut matrix, &mut solution)?;
    Some(solution)
}

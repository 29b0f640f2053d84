//! Parameter identification: the tile's parameters from the normal equations that the station accumulated during its
//! current pulses, by least squares.

use core::ops::RangeInclusive;

use super::cholesky::solve_by_cholesky;
use thermal_device::TICK_HZ;
use thermal_device::identification::{
    NORMAL_EQUATION_AND_STATISTICS_ROWS, NormalEquationRow, StatisticIndex, TIME_UNIT_TICKS_LOG2,
    UNKNOWN_COUNT,
};
use thermal_settings::{Range, Tile};

/// Unit of time, s, in which the station computes the integrals of the normal equations: 2.048 s, which are 2048 ticks
/// of 1 ms. The solution is converted from this unit to seconds.
const EQUATION_TIME_UNIT_S: f64 = (1 << TIME_UNIT_TICKS_LOG2) as f64 / TICK_HZ as f64;
/// Time, s, from the tick that demands a current to its flow: one tick of 1 ms. The normal equations count the dead
/// time from the flow of the current, so this delay is added to their result.
const ACTUATION_DELAY_S: f64 = 1.0 / TICK_HZ as f64;
/// Expected dead time, s, from the flow of a current to the response of a plate like that of the nominal tile. The
/// response determines only the sum of dead time and sensor lag well, so this prior decides how the sum is divided.
const DEAD_TIME_PRIOR_S: f64 = 0.0145;
/// Weight of [`DEAD_TIME_PRIOR_S`] in the fit: what is added to the diagonal element of gain times dead time in the
/// normal matrix, whose elements are in units of 2^-44. A larger weight draws the dead time nearer to the prior.
const DEAD_TIME_PRIOR_WEIGHT: f64 = 1e14;

// Indices of six of the eight unknowns of the normal equations. The equation with their signs stands in
// `thermal_device::identification`; each unknown is divided by `1 + leak lag`. The unknowns 5 and 6 represent the error
// of the baseline reading and a drift, and are not used.
const SENSOR_LAG_INDEX: usize = 0;
const GAIN_INDEX: usize = 1;
const GAIN_TIMES_DEAD_TIME_INDEX: usize = 2;
const GAIN_TIMES_JOULE_INDEX: usize = 3;
const LEAK_INDEX: usize = 4;
const GAIN_TIMES_CURRENT_SENSE_OFFSET_INDEX: usize = 7;

/// One ampere in units of 2^-16 A, in which the station adds up the currents whose ratio is computed.
const CURRENT_UNITS_PER_AMPERE: f64 = 65_536.0;
/// Current, 4.5 A in units of 2^-16 A, at which the ratio of measured to demanded current is evaluated. The ratio
/// depends on the current, because the dead times of the bridge's switches take a constant amount from any current. A
/// large current is chosen, because the parameters must be most accurate for the currents that move the display most.
const RATIO_EVALUATION_CURRENT: f64 = 4.5 * CURRENT_UNITS_PER_AMPERE;

/// Ratios of measured to demanded current that a sound bridge, module and current mirror can have; another ratio ends
/// the identification with [`IdentificationError::CurrentRatio`].
const PLAUSIBLE_MEASURED_TO_DEMANDED_RATIOS: RangeInclusive<f64> = 0.5..=1.5;
/// Dead times, 0.004 to 0.04 s, that an identified tile can have; another ends the identification with
/// [`IdentificationError::OutOfRange`]. A disturbance of the display, such as a touch too light for the force sensor,
/// distorts the dead time before the other parameters.
static PLAUSIBLE_DEAD_TIME: Range = Range { name: "dead time", unit: "s", min: 0.004, max: 0.04 };
/// Lags of the display's thermistor that an identified tile can have; another ends the identification with
/// [`IdentificationError::OutOfRange`]. Up to 0.5 s the surface stays within its limits under every law; a thermistor that lags more is
/// loose, and hides what the surface does.
static CONTROLLABLE_LAG: Range = Range { name: "lag", unit: "s", min: 0.001, max: 0.6 };
/// Largest RMS residual of the fit as a fraction of the fitted signal, which is the time integral of the change of the
/// display's reading. Above it the identification ends with [`IdentificationError::ModelMismatch`]; quantisation by the
/// converter alone leaves 0.007.
const RELATIVE_RESIDUAL_MAX: f64 = 0.02;

/// Why the display's response to the current pulses of `tune` gives no tile. The tile in the settings stays as it was.
#[derive(Clone, Debug, PartialEq)]
pub enum IdentificationError {
    /// The ratio of measured to demanded current, which is the value, lies outside 0.5 to 1.5: bridge, module or
    /// current mirror is defective.
    CurrentRatio(f64),
    /// The normal equations have no solution, as when the display did not respond to the current.
    NoResponse,
    /// The model of a tile does not explain the response: the RMS residual of the fit, given as a fraction of the
    /// fitted signal (the time integral of the change of the display's reading), is above 0.02.
    ModelMismatch(f64),
    /// A parameter of the identified tile lies outside its allowed range. The values are that range, with the
    /// parameter's name and unit, and the parameter in this unit.
    OutOfRange(&'static Range, f64),
}

/// The parameters of the tile whose model fits the response to the current pulses best. `rows` are all sums that the
/// station has added up during `tune`.
///
/// # Errors
/// - [`IdentificationError::CurrentRatio`]: the ratio of measured to demanded current is outside 0.5 to 1.5.
/// - [`IdentificationError::NoResponse`]: the normal equations have no solution.
/// - [`IdentificationError::ModelMismatch`]: the residual of the fit is above 2 % of the fitted signal.
/// - [`IdentificationError::OutOfRange`]: a parameter of the tile is outside its allowed range.
pub fn tile_from_normal_equations(
    rows: &[NormalEquationRow; NORMAL_EQUATION_AND_STATISTICS_ROWS],
) -> Result<Tile, IdentificationError> {
    let [.., totals] = rows;
    let total = |place: StatisticIndex| totals[place as usize] as f64;
    let measured_ratio = measured_to_demanded_current_ratio(total, 0.0);
    if !PLAUSIBLE_MEASURED_TO_DEMANDED_RATIOS.contains(&measured_ratio) {
        return Err(IdentificationError::CurrentRatio(measured_ratio));
    }
    // The prior is one of gain times dead time, so a fit without it determines the gain first.
    let without_prior =
        solve_with_dead_time_prior(rows, 0.0, 0.0).ok_or(IdentificationError::NoResponse)?;
    let gain_dead_time_prior =
        -without_prior[GAIN_INDEX] / EQUATION_TIME_UNIT_S * DEAD_TIME_PRIOR_S;
    let fitted = solve_with_dead_time_prior(rows, DEAD_TIME_PRIOR_WEIGHT, gain_dead_time_prior)
        .ok_or(IdentificationError::NoResponse)?;
    let residual = relative_residual(rows, &fitted, total(StatisticIndex::SquaredRegressand));
    if residual.is_nan() || residual > RELATIVE_RESIDUAL_MAX {
        return Err(IdentificationError::ModelMismatch(residual));
    }
    let flowing_ratio = measured_to_demanded_current_ratio(
        total,
        -fitted[GAIN_TIMES_CURRENT_SENSE_OFFSET_INDEX] / fitted[GAIN_INDEX],
    );
    let (lag, gain, leak) = (
        -fitted[SENSOR_LAG_INDEX] * EQUATION_TIME_UNIT_S,
        -fitted[GAIN_INDEX] / EQUATION_TIME_UNIT_S,
        -fitted[LEAK_INDEX] / EQUATION_TIME_UNIT_S,
    );
    // All unknowns are divided by m = 1 + leak lag, so m is a root of m = 1 + (leak / m) (lag / m) m^2.
    let m = 2.0 / (1.0 + libm::sqrt((1.0 - 4.0 * leak * lag).max(0.0)));
    let tile = Tile::from_array_rounded([
        gain * m * flowing_ratio,
        fitted[GAIN_TIMES_JOULE_INDEX] / EQUATION_TIME_UNIT_S / gain * flowing_ratio,
        leak * m,
        lag * m,
        fitted[GAIN_TIMES_DEAD_TIME_INDEX] / gain + ACTUATION_DELAY_S,
    ]);
    let mut implausible =
        [(&CONTROLLABLE_LAG, tile.sensor_lag_s), (&PLAUSIBLE_DEAD_TIME, tile.dead_time_s)]
            .into_iter()
            .filter(|(range, value)| !range.contains(*value));
    match tile.first_value_out_of_range().or_else(|| implausible.next()) {
        Some((allowed, value)) => Err(IdentificationError::OutOfRange(allowed, value)),
        None => Ok(tile),
    }
}

/// Ratio of measured to demanded current at [`RATIO_EVALUATION_CURRENT`] (4.5 A), from a linear regression over all
/// ticks in which more than 1 A was demanded. `total` returns the station's sum with the given index. `mirror_zero_a`
/// is the current, A, that the current mirror shows while none flows; it is subtracted from the measured current.
fn measured_to_demanded_current_ratio(
    total: impl Fn(StatisticIndex) -> f64,
    mirror_zero_a: f64,
) -> f64 {
    let (ticks, demanded, measured) = (
        total(StatisticIndex::ComparedTicks),
        total(StatisticIndex::Demanded),
        total(StatisticIndex::Measured),
    );
    let slope = (ticks * total(StatisticIndex::DemandedTimesMeasured) - demanded * measured)
        / (ticks * total(StatisticIndex::SquaredDemanded) - demanded * demanded);
    let intercept = (measured - slope * demanded) / ticks;
    slope + (intercept - mirror_zero_a * CURRENT_UNITS_PER_AMPERE) / RATIO_EVALUATION_CURRENT
}

/// RMS residual of the solution `fitted` of the normal equations `rows`, as a fraction of the RMS of the fitted signal,
/// which is the time integral of the change of the display's reading. `response_squared` is the sum of the squares of
/// this signal, in the unit of the rows, 2^-44.
fn relative_residual(
    rows: &[NormalEquationRow; NORMAL_EQUATION_AND_STATISTICS_ROWS],
    fitted: &[f64; UNKNOWN_COUNT],
    response_squared: f64,
) -> f64 {
    let residual_squared: f64 = response_squared
        + rows.iter().zip(fitted).fold(0.0, |sum, (row, x)| {
            let explained: f64 = row.iter().zip(fitted).map(|(a, y)| *a as f64 * y).sum();
            sum + x * (explained - 2.0 * row[UNKNOWN_COUNT] as f64)
        });
    libm::sqrt(residual_squared.max(0.0) / response_squared)
}

/// Solves the normal equations for the eight unknowns, together with a prior: the unknown gain times dead time equals
/// `gain_dead_time`, K/A. `prior_weight` is added to its diagonal element of the normal matrix, in units of 2^-44; a
/// weight of 0 leaves the prior out. Returns `None` if the equations are numerically singular.
fn solve_with_dead_time_prior(
    rows: &[NormalEquationRow; NORMAL_EQUATION_AND_STATISTICS_ROWS],
    prior_weight: f64,
    gain_dead_time: f64,
) -> Option<[f64; UNKNOWN_COUNT]> {
    let mut matrix: [[f64; UNKNOWN_COUNT]; UNKNOWN_COUNT] =
        core::array::from_fn(|i| core::array::from_fn(|j| rows[i][j] as f64));
    let mut solution: [f64; UNKNOWN_COUNT] =
        core::array::from_fn(|i| rows[i][UNKNOWN_COUNT] as f64);
    matrix[GAIN_TIMES_DEAD_TIME_INDEX][GAIN_TIMES_DEAD_TIME_INDEX] += prior_weight;
    solution[GAIN_TIMES_DEAD_TIME_INDEX] += prior_weight * gain_dead_time;
    solve_by_cholesky(&mut matrix, &mut solution)?;
    Some(solution)
}

//! Direct maximisation of the likelihood of a psychometric function by grids that are refined, to compare fits with.

use experiment_statistics::psychometric::Level;

/// Logarithms of the slope: a function with the smallest one is a constant, with the largest one a step, for levels a factor of
/// 1.41 apart.
pub const LOG_SLOPES: (f64, f64) = (-12.0, 5.0);
/// Argument `ln(-ln(1 - G))` at a level: `G` from 1e-13 to 1 - 1e-13.
const ARGUMENTS: (f64, f64) = (-30.0, 3.4);
/// Points of the first grid to either side of its middle.
const FIRST_POINTS: [i32; 3] = [16, 16, 1];
/// Size of the first of the smaller grids, and of the last one, as a part of the first grid.
const SIZES: (f64, f64) = (0.1, 1e-5);
/// Least gain of log-likelihood for which a grid moves.
const GAIN: f64 = 1e-9;

/// Argument at a level, logarithm of the slope, lapse rate.
type Function = [f64; 3];

/// Smallest deviance of a Weibull function of 2AFC within a range of the logarithm of the slope and a lapse rate from 0 to
/// `lapse_max`. The function is described by its argument at a level, for each level in turn, so that the grid resolves a steep
/// function wherever it rises.
pub fn least_deviance(levels: &[Level], log_slopes: (f64, f64), lapse_max: f64) -> f64 {
    let ranges = [ARGUMENTS, log_slopes, (0.0, lapse_max)];
    let middle = ranges.map(|(least, most)| 0.5 * (least + most));
    let searches = levels.iter().map(|place| {
        let likelihood = |function: Function| log_likelihood(levels, place.level, function);
        let found = best_around(middle, (1.0, FIRST_POINTS), ranges, likelihood);
        (place.level, found)
    });
    let best = searches.max_by(|(_, one), (_, other)| one.1.total_cmp(&other.1));
    let (place, mut best) = best.expect("a level");
    let likelihood = |function: Function| log_likelihood(levels, place, function);
    let mut size = SIZES.0;
    while size > SIZES.1 {
        let found = best_around(best.0, (size, [2; 3]), ranges, likelihood);
        if found.1 < best.1 + GAIN {
            size *= 0.5;
        }
        best = if found.1 > best.1 { found } else { best };
    }
    let saturated = levels.iter().map(|level| binomial(level, level.answers.value()));
    2.0 * (saturated.sum::<f64>() - best.1)
}

/// The most likely function of a grid around a centre, of a size as a part of the ranges.
fn best_around(
    centre: Function,
    (size, points): (f64, [i32; 3]),
    ranges: [(f64, f64); 3],
    likelihood: impl Fn(Function) -> f64,
) -> (Function, f64) {
    let along = |i: usize| -> Vec<f64> {
        let (least, most) = ranges[i];
        let step = 0.5 * size * (most - least) / f64::from(points[i]);
        let steps = (-points[i]..=points[i]).map(|n| centre[i] + step * f64::from(n));
        let mut along: Vec<f64> = steps.map(|value| value.clamp(least, most)).collect();
        along.dedup();
        along
    };
    let [arguments, log_slopes, lapses] = [along(0), along(1), along(2)];
    let mut best = (centre, f64::NEG_INFINITY);
    for argument in arguments {
        for &log_slope in &log_slopes {
            for &lapse in &lapses {
                let function = [argument, log_slope, lapse];
                let reached = likelihood(function);
                if reached > best.1 {
                    best = (function, reached);
                }
            }
        }
    }
    best
}

fn log_likelihood(levels: &[Level], place: f64, [argument, log_slope, lapse]: Function) -> f64 {
    let slope = log_slope.exp();
    let of_level = |level: &Level| {
        let argument = argument + slope * (level.level / place).ln();
        binomial(level, 0.5 + (0.5 - lapse) * -(-argument.exp()).exp_m1())
    };
    levels.iter().map(of_level).sum()
}

/// Log-likelihood of the answers at a level, without the binomial coefficient.
fn binomial(level: &Level, p: f64) -> f64 {
    let (correct, total) = (f64::from(level.answers.correct()), f64::from(level.answers.total()));
    let term = |count: f64, p: f64| if count == 0.0 { 0.0 } else { count * p.ln() };
    term(correct, p) + term(total - correct, 1.0 - p)
}

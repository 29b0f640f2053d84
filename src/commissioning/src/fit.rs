//! From points to a calibration: least squares, with what parts of these classes are likely to be.
//!
//! Display and second display are one system: both read what the same converter makes of them, so they share its
//! steps. The other thermistors have too few points to find any; they use those.

use super::points::{Point, Points};
use super::solve::solve;
use thermal_device::sense::THERMISTORS;
use thermal_settings::{
    BORDERS, Calibration, Correction, FIRST_BORDER, MIDDLE_C, REACH_K, SEGMENT_CODES, Settings,
};

/// Thermistors whose points show the converter's steps: the first of all.
pub const SWEPT: usize = 2;
const COEFFICIENTS: usize = 3;
const UNKNOWNS: usize = SWEPT * COEFFICIENTS + BORDERS;
/// Standard deviations: of a point, K; of offset, slope and curvature of thermistors of 1 %; of a step, counts.
const POINT_K: f64 = 0.5e-3;
const LIKELY: [f64; COEFFICIENTS] = [0.5, 0.02, 2e-4];
const STEP_COUNTS: f64 = 1.0;
/// The steps move the temperature at which a correction is taken: this often until that no longer matters.
const ROUNDS: usize = 2;

/// A reading's temperature by the class values, without calibration.
fn class_c(settings: &Settings, thermistor: usize, sum: f64) -> f64 {
    let warmer_k = settings
        .self_heating_k
        .get(thermistor)
        .copied()
        .unwrap_or(0.0);
    settings.thermistor.temperature_c(sum) - warmer_k
}

/// Borders with a known step below a mean sum.
fn borders_below(sum: f64) -> usize {
    let segment = (sum / f64::from(16 * SEGMENT_CODES)) as usize;
    (segment + 1).saturating_sub(FIRST_BORDER).min(BORDERS)
}

/// The three powers that a correction is made of.
fn powers(reads_c: f64) -> [f64; COEFFICIENTS] {
    let u = (reads_c - MIDDLE_C).clamp(-REACH_K, REACH_K);
    [1.0, u, u * u]
}

/// What the device reads for a mean sum with a calibration, °C; not at a border.
#[must_use]
pub fn reading_c(
    settings: &Settings,
    calibration: &Calibration,
    thermistor: usize,
    sum: f64,
) -> f64 {
    let steps: f64 = calibration
        .steps_counts
        .iter()
        .take(borders_below(sum))
        .sum();
    let reached_c = class_c(settings, thermistor, sum - 16.0 * steps);
    let warmer_k = settings
        .self_heating_k
        .get(thermistor)
        .copied()
        .unwrap_or(0.0);
    let correction = calibration
        .corrections
        .get(thermistor)
        .copied()
        .unwrap_or_default();
    let [one, u, square] = powers(reached_c + warmer_k);
    reached_c + correction.offset_k * one + correction.slope * u + correction.curvature_1_k * square
}

/// One point as an equation: what the correction must be, its powers, and K per count of a step.
struct Row {
    wanted_k: f64,
    powers: [f64; COEFFICIENTS],
    borders: usize,
    k_per_count: f64,
}

fn row(settings: &Settings, steps: &[f64; BORDERS], thermistor: usize, point: &Point) -> Row {
    let borders = borders_below(point.sum);
    let too_much: f64 = steps.iter().take(borders).sum();
    let without = point.sum - 16.0 * too_much;
    let reached_c = settings.thermistor.temperature_c(without);
    let warmer_k = settings
        .self_heating_k
        .get(thermistor)
        .copied()
        .unwrap_or(0.0);
    Row {
        wanted_k: point.reference_c - (reached_c - warmer_k),
        powers: powers(reached_c),
        borders,
        // A count less of 16 sums, which is warmer.
        k_per_count: settings.thermistor.temperature_c(without - 16.0) - reached_c,
    }
}

/// The calibration that fits all points and is likely beside one of `before` them; a thermistor without points keeps
/// that correction, and the steps stay if neither of the display's has any.
///
/// `None` if numbers fail.
#[must_use]
pub fn fit(settings: &Settings, before: &Calibration, points: &Points) -> Option<Calibration> {
    let mut calibration = *before;
    if (0..SWEPT).any(|thermistor| !points.of(thermistor).is_empty()) {
        for _ in 0..ROUNDS {
            swept(settings, before, points, &mut calibration)?;
        }
    }
    for thermistor in SWEPT..THERMISTORS {
        single(settings, points, thermistor, &mut calibration)?;
    }
    Some(calibration.rounded())
}

/// Adds an equation with few coefficients other than zero to the normal equations; places that they do not have are
/// left out.
fn add<const N: usize>(
    normal: &mut [[f64; N]; N],
    right: &mut [f64; N],
    equation: &[(usize, f64)],
    wanted: f64,
    deviation: f64,
) {
    let weight = 1.0 / (deviation * deviation);
    for &(i, a) in equation {
        let (Some(row), Some(sum)) = (normal.get_mut(i), right.get_mut(i)) else {
            continue;
        };
        *sum += weight * a * wanted;
        for &(j, b) in equation {
            if let Some(product) = row.get_mut(j).filter(|_| j <= i) {
                *product += weight * a * b;
            }
        }
    }
}

/// Both display thermistors and the steps.
fn swept(
    settings: &Settings,
    before: &Calibration,
    points: &Points,
    calibration: &mut Calibration,
) -> Option<()> {
    let (mut normal, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
    let steps = calibration.steps_counts;
    for thermistor in 0..SWEPT {
        let first = thermistor * COEFFICIENTS;
        let likely = coefficients(&before.corrections[thermistor])
            .into_iter()
            .zip(LIKELY);
        for (i, (value, deviation)) in likely.enumerate() {
            add(
                &mut normal,
                &mut right,
                &[(first + i, 1.0)],
                value,
                deviation,
            );
        }
        for point in points.of(thermistor) {
            let row = row(settings, &steps, thermistor, point);
            let mut equation = heapless::Vec::<_, UNKNOWNS>::new();
            for (i, power) in row.powers.into_iter().enumerate() {
                let _ = equation.push((first + i, power));
            }
            for border in 0..row.borders {
                let _ = equation.push((SWEPT * COEFFICIENTS + border, row.k_per_count));
            }
            // The steps are found whole, not what they differ from those of the round before.
            let taken_out: f64 = steps.iter().take(row.borders).sum();
            let wanted_k = row.wanted_k + row.k_per_count * taken_out;
            add(&mut normal, &mut right, &equation, wanted_k, POINT_K);
        }
    }
    for (border, step) in before.steps_counts.into_iter().enumerate() {
        let i = SWEPT * COEFFICIENTS + border;
        add(&mut normal, &mut right, &[(i, 1.0)], step, STEP_COUNTS);
    }
    solve(&mut normal, &mut right, UNKNOWNS)?;
    for thermistor in 0..SWEPT {
        if !points.of(thermistor).is_empty() {
            let first = thermistor * COEFFICIENTS;
            calibration.corrections[thermistor] =
                correction([right[first], right[first + 1], right[first + 2]]);
        }
    }
    for (border, step) in calibration.steps_counts.iter_mut().enumerate() {
        *step = right[SWEPT * COEFFICIENTS + border];
    }
    Some(())
}

/// One other thermistor, with the steps as they are.
fn single(
    settings: &Settings,
    points: &Points,
    thermistor: usize,
    calibration: &mut Calibration,
) -> Option<()> {
    if points.of(thermistor).is_empty() {
        return Some(());
    }
    let (mut normal, mut right) = ([[0.0; COEFFICIENTS]; COEFFICIENTS], [0.0; COEFFICIENTS]);
    let likely = coefficients(&calibration.corrections[thermistor])
        .into_iter()
        .zip(LIKELY);
    for (i, (value, deviation)) in likely.enumerate() {
        add(&mut normal, &mut right, &[(i, 1.0)], value, deviation);
    }
    for point in points.of(thermistor) {
        let row = row(settings, &calibration.steps_counts, thermistor, point);
        let [one, u, square] = row.powers;
        let equation = [(0, one), (1, u), (2, square)];
        add(&mut normal, &mut right, &equation, row.wanted_k, POINT_K);
    }
    solve(&mut normal, &mut right, COEFFICIENTS)?;
    calibration.corrections[thermistor] = correction(right);
    Some(())
}

const fn correction([offset_k, slope, curvature_1_k]: [f64; COEFFICIENTS]) -> Correction {
    Correction {
        offset_k,
        slope,
        curvature_1_k,
    }
}

const fn coefficients(correction: &Correction) -> [f64; COEFFICIENTS] {
    let Correction {
        offset_k,
        slope,
        curvature_1_k,
    } = *correction;
    [offset_k, slope, curvature_1_k]
}

//! Calibration fit: Bayesian least squares over the calibration points, with the present calibration and the tolerances
//! of the components as the prior.
//!
//! Both thermistors of the display are fitted together with the steps of the converter that they share. The other
//! thermistors have too few points to determine steps; they are fitted afterwards, with the steps held fixed.

use super::calibration_points::{Point, Points};
use super::cholesky::solve;
use thermal_device::sense::THERMISTORS;
use thermal_settings::{
    BORDER_COUNT, CORRECTION_CENTER_C, CORRECTION_HALF_SPAN_K, Calibration, Correction,
    FIRST_BORDER, SEGMENT_CODES, Settings,
};

/// Number of thermistors of the display, the first ones, whose points determine the converter's steps.
pub const DISPLAY_SENSORS: usize = 2;
const COEFFICIENTS: usize = 3;
/// Unknowns of the joint fit: the corrections of the display's thermistors, then the steps.
const JOINT_UNKNOWNS: usize = FIRST_STEP + BORDER_COUNT;
const FIRST_STEP: usize = DISPLAY_SENSORS * COEFFICIENTS;
/// Standard deviation of a calibration point, K.
const POINT_DEVIATION_K: f64 = 0.5e-3;
/// Prior standard deviations of offset, K, slope, K/K, and curvature, 1/K, for thermistors with a tolerance of 1 %.
const COEFFICIENT_DEVIATIONS: [f64; COEFFICIENTS] = [0.5, 0.02, 2e-4];
/// Prior standard deviation of a step, counts.
const STEP_DEVIATION_COUNTS: f64 = 1.0;
/// Iterations of the joint fit: the steps shift the temperature at which the correction is evaluated, which converges to
/// below the resolution after two.
const ITERATIONS: usize = 2;

/// Self-heating of a thermistor, K.
fn self_heating_k(settings: &Settings, sensor: usize) -> f64 {
    let self_heating_k = settings.self_heating_k.get(sensor);
    self_heating_k.copied().unwrap_or(0.0)
}

/// Number of calibrated borders below a mean sum of 16 conversions.
fn borders_below(sum: f64) -> usize {
    let segment = (sum / f64::from(16 * SEGMENT_CODES)) as usize;
    (segment + 1).saturating_sub(FIRST_BORDER).min(BORDER_COUNT)
}

/// The factors of a correction's offset, slope and curvature at the temperature of a thermistor.
fn powers(thermistor_c: f64) -> [f64; COEFFICIENTS] {
    let u =
        (thermistor_c - CORRECTION_CENTER_C).clamp(-CORRECTION_HALF_SPAN_K, CORRECTION_HALF_SPAN_K);
    [1.0, u, u * u]
}

/// The reading, °C, that the device computes from a mean sum of 16 conversions; not valid within a segment border.
#[must_use]
pub fn reading_c(settings: &Settings, sensor: usize, sum: f64) -> f64 {
    let Calibration {
        steps_counts,
        corrections,
    } = &settings.calibration;
    let steps: f64 = steps_counts.iter().take(borders_below(sum)).sum();
    let self_heating_k = self_heating_k(settings, sensor);
    let uncorrected_c = settings.thermistor.temperature_c(sum - 16.0 * steps) - self_heating_k;
    let correction = corrections.get(sensor).copied().unwrap_or_default();
    let [one, u, square] = powers(uncorrected_c + self_heating_k);
    uncorrected_c
        + correction.offset_k * one
        + correction.slope * u
        + correction.curvature_1_k * square
}

/// A calibration point as an observation equation.
struct Observation {
    /// Reference minus uncorrected reading, with the present steps removed from the reading, K.
    deviation_k: f64,
    /// Factors of the correction's coefficients.
    powers: [f64; COEFFICIENTS],
    /// Number of steps that the reading contains.
    borders: usize,
    /// Sensitivity of the reading to each of these steps, K per count.
    k_per_count: f64,
}

impl Observation {
    fn new(settings: &Settings, steps: &[f64; BORDER_COUNT], sensor: usize, point: &Point) -> Self {
        let borders = borders_below(point.sum);
        let step_counts: f64 = steps.iter().take(borders).sum();
        let sum = point.sum - 16.0 * step_counts;
        let thermistor_c = settings.thermistor.temperature_c(sum);
        Self {
            deviation_k: point.reference_c - (thermistor_c - self_heating_k(settings, sensor)),
            powers: powers(thermistor_c),
            borders,
            // One count less, 16 in the sum, is a higher temperature.
            k_per_count: settings.thermistor.temperature_c(sum - 16.0) - thermistor_c,
        }
    }
}

/// Normal equations of weighted least squares with `N` unknowns.
struct NormalEquations<const N: usize> {
    /// Normal matrix, of which only the lower triangle is filled.
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> NormalEquations<N> {
    const fn new() -> Self {
        Self {
            matrix: [[0.0; N]; N],
            right: [0.0; N],
        }
    }

    /// Adds the equation `sum of factor * x[index] over terms = value` with a standard deviation; terms whose index is
    /// out of bounds are ignored.
    fn add(&mut self, terms: &[(usize, f64)], value: f64, deviation: f64) {
        let weight = 1.0 / (deviation * deviation);
        for &(i, a) in terms {
            let (Some(row), Some(sum)) = (self.matrix.get_mut(i), self.right.get_mut(i)) else {
                continue;
            };
            *sum += weight * a * value;
            for &(j, b) in terms {
                if let Some(product) = row.get_mut(j).filter(|_| j <= i) {
                    *product += weight * a * b;
                }
            }
        }
    }

    /// Adds the prior of a correction whose coefficients are the unknowns from `first` on.
    fn add_prior(&mut self, first: usize, correction: &Correction) {
        let coefficients = correction.to_array().into_iter();
        for (i, (value, deviation)) in coefficients.zip(COEFFICIENT_DEVIATIONS).enumerate() {
            self.add(&[(first + i, 1.0)], value, deviation);
        }
    }

    /// The most likely unknowns, or `None` if the equations are numerically singular.
    fn solve(mut self) -> Option<[f64; N]> {
        solve(&mut self.matrix, &mut self.right)?;
        Some(self.right)
    }
}

/// The most likely calibration given all points and a prior calibration. A thermistor without points keeps its present
/// correction, and the steps are kept if no thermistor of the display has points.
///
/// Returns `None` if the equations are numerically singular.
#[must_use]
pub fn fit(settings: &Settings, prior: &Calibration, points: &Points) -> Option<Calibration> {
    let mut calibration = *prior;
    if (0..DISPLAY_SENSORS).any(|sensor| !points.of_sensor(sensor).is_empty()) {
        for _ in 0..ITERATIONS {
            fit_display(settings, prior, points, &mut calibration)?;
        }
    }
    for sensor in DISPLAY_SENSORS..THERMISTORS {
        fit_single(settings, points, sensor, &mut calibration)?;
    }
    Some(calibration.rounded())
}

/// Fits the corrections of the display's thermistors and the steps of the converter.
fn fit_display(
    settings: &Settings,
    prior: &Calibration,
    points: &Points,
    calibration: &mut Calibration,
) -> Option<()> {
    let mut equations = NormalEquations::<JOINT_UNKNOWNS>::new();
    let steps = calibration.steps_counts;
    for sensor in 0..DISPLAY_SENSORS {
        let first = sensor * COEFFICIENTS;
        equations.add_prior(first, &prior.corrections[sensor]);
        for point in points.of_sensor(sensor) {
            let observation = Observation::new(settings, &steps, sensor, point);
            let mut terms = heapless::Vec::<_, JOINT_UNKNOWNS>::new();
            for (i, power) in observation.powers.into_iter().enumerate() {
                let _ = terms.push((first + i, power));
            }
            for border in 0..observation.borders {
                let _ = terms.push((FIRST_STEP + border, observation.k_per_count));
            }
            // The unknowns are the steps themselves, not their changes, so the present steps are added back.
            let removed_counts: f64 = steps.iter().take(observation.borders).sum();
            let deviation_k = observation.deviation_k + observation.k_per_count * removed_counts;
            equations.add(&terms, deviation_k, POINT_DEVIATION_K);
        }
    }
    for (border, step) in prior.steps_counts.into_iter().enumerate() {
        equations.add(&[(FIRST_STEP + border, 1.0)], step, STEP_DEVIATION_COUNTS);
    }
    let solution = equations.solve()?;
    for sensor in 0..DISPLAY_SENSORS {
        if !points.of_sensor(sensor).is_empty() {
            let first = sensor * COEFFICIENTS;
            calibration.corrections[sensor] =
                Correction::from_array([solution[first], solution[first + 1], solution[first + 2]]);
        }
    }
    for (border, step) in calibration.steps_counts.iter_mut().enumerate() {
        *step = solution[FIRST_STEP + border];
    }
    Some(())
}

/// Fits the correction of one other thermistor.
fn fit_single(
    settings: &Settings,
    points: &Points,
    sensor: usize,
    calibration: &mut Calibration,
) -> Option<()> {
    if points.of_sensor(sensor).is_empty() {
        return Some(());
    }
    let mut equations = NormalEquations::<COEFFICIENTS>::new();
    equations.add_prior(0, &calibration.corrections[sensor]);
    for point in points.of_sensor(sensor) {
        let Observation {
            deviation_k,
            powers: [one, u, square],
            ..
        } = Observation::new(settings, &calibration.steps_counts, sensor, point);
        equations.add(
            &[(0, one), (1, u), (2, square)],
            deviation_k,
            POINT_DEVIATION_K,
        );
    }
    calibration.corrections[sensor] = Correction::from_array(equations.solve()?);
    Some(())
}

//! Calibration fit: Bayesian least squares over the calibration points, with the present calibration and the tolerances
//! of the components as the prior.
//!
//! Both thermistors of the display are fitted together with the steps of the converter that they share. The other
//! thermistors have too few points to determine steps; they are fitted afterwards, with the steps held fixed.

use super::calibration_points::{CalibrationPoint, CalibrationPoints};
use super::cholesky::solve_by_cholesky;
use thermal_device::sense::THERMISTOR_COUNT;
use thermal_settings::{
    CALIBRATED_ADC_BORDER_COUNT, CODES_PER_ADC_SEGMENT, CORRECTION_POLYNOMIAL_CENTER_C,
    CORRECTION_POLYNOMIAL_CLAMP_K, Calibration, Correction, FIRST_CALIBRATED_ADC_BORDER_INDEX,
    Settings,
};

/// Number of the display's thermistors, which have the indices 0 and 1. Only their calibration points determine the
/// steps of the converter at the borders of its segments; those of sink, skin and room (2 to 4) do not.
pub const DISPLAY_THERMISTOR_COUNT: usize = 2;
const COEFFICIENTS_PER_CORRECTION: usize = 3;
/// Number of unknowns of the joint fit, 19: three coefficients of the correction of each of the two display
/// thermistors, then the converter's steps at 13 borders of its segments.
const JOINT_FIT_UNKNOWN_COUNT: usize = FIRST_STEP_UNKNOWN_INDEX + CALIBRATED_ADC_BORDER_COUNT;
const FIRST_STEP_UNKNOWN_INDEX: usize = DISPLAY_THERMISTOR_COUNT * COEFFICIENTS_PER_CORRECTION;
/// Assumed standard deviation, K, of the error of a calibration point: 0.5 mK. The fit weights each point by the
/// inverse of its square.
const POINT_STANDARD_DEVIATION_K: f64 = 0.5e-3;
/// Assumed standard deviations of a correction's offset (K), slope (K/K) and curvature (1/K) from their prior values:
/// those of thermistors with a tolerance of 1 %. The fit weights the prior by the inverse of their squares.
const COEFFICIENT_PRIOR_STANDARD_DEVIATIONS: [f64; COEFFICIENTS_PER_CORRECTION] = [0.5, 0.02, 2e-4];
/// Assumed standard deviation, converter counts, of each of the converter's 13 steps at the borders of its segments
/// from its prior value: that of a converter of this class. The fit weights the prior by the inverse of its square.
const STEP_PRIOR_STANDARD_DEVIATION_COUNTS: f64 = 1.0;
/// Iterations of the joint fit of the display thermistors' corrections and the converter's steps. A correction is
/// evaluated at a temperature that depends on the steps, so the fit is done a second time with the steps of the first
/// fit; a third fit would change no reading noticeably.
const JOINT_FIT_ITERATIONS: usize = 2;

/// Self-heating, K, of the thermistor with the index `sensor`, from the settings: how much warmer its measuring current
/// makes it than what it measures. 0 for an index above 4.
fn self_heating_setting_k(settings: &Settings, sensor: usize) -> f64 {
    let self_heating_k = settings.self_heating_k.get(sensor);
    self_heating_k.copied().unwrap_or(0.0)
}

/// Number of the 13 calibrated segment borders of the converter (codes 1280 to 2816 in steps of 128) at or below a
/// reading, which is a mean sum of 16 conversions, 0 to 65520.
fn calibrated_border_count_below(sum: f64) -> usize {
    let segment = (sum / f64::from(16 * CODES_PER_ADC_SEGMENT)) as usize;
    (segment + 1).saturating_sub(FIRST_CALIBRATED_ADC_BORDER_INDEX).min(CALIBRATED_ADC_BORDER_COUNT)
}

/// The factors `1`, `u` and `u²` of a correction's offset, slope and curvature for a thermistor at `thermistor_c`, °C:
/// `u` is the difference from 29 °C, limited to ±16 K.
fn polynomial_terms(thermistor_c: f64) -> [f64; COEFFICIENTS_PER_CORRECTION] {
    let u = (thermistor_c - CORRECTION_POLYNOMIAL_CENTER_C)
        .clamp(-CORRECTION_POLYNOMIAL_CLAMP_K, CORRECTION_POLYNOMIAL_CLAMP_K);
    [1.0, u, u * u]
}

/// The temperature, °C, that the device computes with these settings for the thermistor with the index `sensor` from a
/// mean sum of 16 conversions, 0 to 65520. It is not valid within two codes of a segment border, where the device
/// interpolates the converter's step, nor if the steps add up to more than 8 counts, to which the device limits them.
pub fn calibrated_temperature_c(settings: &Settings, sensor: usize, sum: f64) -> f64 {
    let Calibration { steps_counts, corrections } = &settings.calibration;
    let steps: f64 = steps_counts.iter().take(calibrated_border_count_below(sum)).sum();
    let self_heating_k = self_heating_setting_k(settings, sensor);
    let uncorrected_c = settings.thermistor.temperature_c(sum - 16.0 * steps) - self_heating_k;
    let correction = corrections.get(sensor).copied().unwrap_or_default();
    let [one, u, square] = polynomial_terms(uncorrected_c + self_heating_k);
    uncorrected_c
        + correction.offset_k * one
        + correction.slope * u
        + correction.curvature_1_k * square
}

/// The linear equation that a calibration point adds to the least squares: `polynomial_terms` times the coefficients of
/// the correction, plus `k_per_count` times the change of each converter step below the reading, equals `deviation_k`.
struct CalibrationPointEquation {
    /// Temperature of the reference thermometer minus the uncorrected temperature, K. The uncorrected temperature is
    /// that of the calibration point's reading minus the present converter steps at all borders below the reading, less
    /// the thermistor's self-heating.
    deviation_k: f64,
    /// Factors `1`, `u` and `u²` of the correction's offset, slope and curvature. `u` is the thermistor's temperature
    /// minus 29 °C, limited to ±16 K.
    polynomial_terms: [f64; COEFFICIENTS_PER_CORRECTION],
    /// Number of calibrated segment borders of the converter below the calibration point's reading. The reading
    /// contains the converter's step at each of these borders.
    borders: usize,
    /// Rise of the uncorrected temperature, K, if the converter's step at a border below the reading is one count
    /// larger. It is positive: the step is subtracted from the reading, and a smaller reading is a higher temperature.
    k_per_count: f64,
}

impl CalibrationPointEquation {
    fn new(
        settings: &Settings,
        steps: &[f64; CALIBRATED_ADC_BORDER_COUNT],
        sensor: usize,
        point: &CalibrationPoint,
    ) -> Self {
        let borders = calibrated_border_count_below(point.sum);
        let step_counts: f64 = steps.iter().take(borders).sum();
        let sum = point.sum - 16.0 * step_counts;
        let thermistor_c = settings.thermistor.temperature_c(sum);
        Self {
            deviation_k: point.reference_c
                - (thermistor_c - self_heating_setting_k(settings, sensor)),
            polynomial_terms: polynomial_terms(thermistor_c),
            borders,
            // One count less, 16 in the sum, is a higher temperature.
            k_per_count: settings.thermistor.temperature_c(sum - 16.0) - thermistor_c,
        }
    }
}

/// Normal equations of weighted least squares with `N` unknowns: a matrix and a right-hand side, to which equations are
/// added one by one.
struct NormalEquations<const N: usize> {
    /// Normal matrix: element `i, j` is the weighted sum, over all added equations, of the product of the factors of
    /// the unknowns `i` and `j`. Only the lower triangle is filled, because the matrix is symmetric.
    matrix: [[f64; N]; N],
    right: [f64; N],
}

impl<const N: usize> NormalEquations<N> {
    const fn new() -> Self {
        Self { matrix: [[0.0; N]; N], right: [0.0; N] }
    }

    /// Adds the equation "the sum of `factor * x[index]` over all `(index, factor)` in `terms` equals `value`".
    /// `deviation` is its standard deviation in the unit of `value`; the weight is `1 / deviation²`. A term whose index
    /// is `N` or larger is ignored.
    fn add_equation(&mut self, terms: &[(usize, f64)], value: f64, deviation: f64) {
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

    /// Adds three equations that state the prior of one correction: its offset, slope and curvature, which are the
    /// unknowns `first` to `first + 2`, equal those of `correction`, with [`COEFFICIENT_PRIOR_STANDARD_DEVIATIONS`].
    fn add_prior_correction_equations(&mut self, first: usize, correction: &Correction) {
        let coefficients = correction.to_array().into_iter();
        for (i, (value, deviation)) in
            coefficients.zip(COEFFICIENT_PRIOR_STANDARD_DEVIATIONS).enumerate()
        {
            self.add_equation(&[(first + i, 1.0)], value, deviation);
        }
    }

    /// Solves the normal equations for the `N` unknowns that fit the added equations best; `None` if the matrix is
    /// numerically singular. Overwrites the equations, of which a copy would need 3 KB of stack.
    fn solve(&mut self) -> Option<[f64; N]> {
        solve_by_cholesky(&mut self.matrix, &mut self.right)?;
        Some(self.right)
    }
}

/// The most likely calibration, given all calibration points and the calibration `prior` from before them, rounded to
/// the decimals that are stored. A thermistor without points gets its correction from `prior`. The converter's steps at
/// its segment borders are those of `prior` if neither display thermistor has points.
///
/// Returns `None` if the equations are numerically singular.
pub fn fit_calibration(
    settings: &Settings,
    prior: &Calibration,
    points: &CalibrationPoints,
) -> Option<Calibration> {
    let mut calibration = *prior;
    if (0..DISPLAY_THERMISTOR_COUNT).any(|sensor| !points.of_sensor(sensor).is_empty()) {
        for _ in 0..JOINT_FIT_ITERATIONS {
            iterate_display_and_steps_fit(settings, prior, points, &mut calibration)?;
        }
    }
    for sensor in DISPLAY_THERMISTOR_COUNT..THERMISTOR_COUNT {
        fit_thermistor_with_fixed_steps(settings, points, sensor, &mut calibration)?;
    }
    Some(calibration.rounded())
}

/// One iteration of the joint fit: replaces in `calibration` the converter's 13 steps and the corrections of those
/// display thermistors that have points. The points are evaluated with the steps that `calibration` had before. Returns
/// `None` if the equations are numerically singular.
fn iterate_display_and_steps_fit(
    settings: &Settings,
    prior: &Calibration,
    points: &CalibrationPoints,
    calibration: &mut Calibration,
) -> Option<()> {
    let mut equations = NormalEquations::<JOINT_FIT_UNKNOWN_COUNT>::new();
    let steps = calibration.steps_counts;
    for sensor in 0..DISPLAY_THERMISTOR_COUNT {
        let first = sensor * COEFFICIENTS_PER_CORRECTION;
        equations.add_prior_correction_equations(first, &prior.corrections[sensor]);
        for point in points.of_sensor(sensor) {
            let observation = CalibrationPointEquation::new(settings, &steps, sensor, point);
            let mut terms = heapless::Vec::<_, JOINT_FIT_UNKNOWN_COUNT>::new();
            for (i, term) in observation.polynomial_terms.into_iter().enumerate() {
                let _ = terms.push((first + i, term));
            }
            for border in 0..observation.borders {
                let _ = terms.push((FIRST_STEP_UNKNOWN_INDEX + border, observation.k_per_count));
            }
            // The unknowns are the steps themselves, not their changes, so the present steps are added back.
            let removed_counts: f64 = steps.iter().take(observation.borders).sum();
            let deviation_k = observation.deviation_k + observation.k_per_count * removed_counts;
            equations.add_equation(&terms, deviation_k, POINT_STANDARD_DEVIATION_K);
        }
    }
    for (border, step) in prior.steps_counts.into_iter().enumerate() {
        equations.add_equation(
            &[(FIRST_STEP_UNKNOWN_INDEX + border, 1.0)],
            step,
            STEP_PRIOR_STANDARD_DEVIATION_COUNTS,
        );
    }
    let solution = equations.solve()?;
    for sensor in 0..DISPLAY_THERMISTOR_COUNT {
        if !points.of_sensor(sensor).is_empty() {
            let first = sensor * COEFFICIENTS_PER_CORRECTION;
            calibration.corrections[sensor] =
                Correction::from_array([solution[first], solution[first + 1], solution[first + 2]]);
        }
    }
    for (border, step) in calibration.steps_counts.iter_mut().enumerate() {
        *step = solution[FIRST_STEP_UNKNOWN_INDEX + border];
    }
    Some(())
}

/// Fits the correction of the thermistor with the index `sensor` (sink, skin or room) to its points, and replaces it in
/// `calibration`. The converter's steps stay fixed. Without points nothing changes. Returns `None` if the equations are
/// numerically singular.
fn fit_thermistor_with_fixed_steps(
    settings: &Settings,
    points: &CalibrationPoints,
    sensor: usize,
    calibration: &mut Calibration,
) -> Option<()> {
    if points.of_sensor(sensor).is_empty() {
        return Some(());
    }
    let mut equations = NormalEquations::<COEFFICIENTS_PER_CORRECTION>::new();
    equations.add_prior_correction_equations(0, &calibration.corrections[sensor]);
    for point in points.of_sensor(sensor) {
        let CalibrationPointEquation { deviation_k, polynomial_terms: [one, u, square], .. } =
            CalibrationPointEquation::new(settings, &calibration.steps_counts, sensor, point);
        equations.add_equation(
            &[(0, one), (1, u), (2, square)],
            deviation_k,
            POINT_STANDARD_DEVIATION_K,
        );
    }
    calibration.corrections[sensor] = Correction::from_array(equations.solve()?);
    Some(())
}

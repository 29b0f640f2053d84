//! Least squares with unknowns that are not negative.

use nalgebra::{DMatrix, DVector};

/// Largest number of iterations, each of which lets one more unknown be positive.
const ITERATIONS_MAX: usize = 2000;

/// The `x >= 0` that minimises `|a x - b|`, by the active-set method of Lawson and Hanson (1974). After [`ITERATIONS_MAX`]
/// iterations it returns the latest `x >= 0`.
pub fn solve(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let unknowns = a.ncols();
    let mut x = DVector::zeros(unknowns);
    let mut positive: Vec<usize> = Vec::new();
    let scale = (a.transpose() * b).amax();
    for _ in 0..ITERATIONS_MAX {
        let gradient = a.transpose() * (b - a * &x);
        let entering = (0..unknowns)
            .filter(|column| !positive.contains(column))
            .max_by(|&i, &j| gradient[i].total_cmp(&gradient[j]));
        match entering {
            Some(column) if gradient[column] > 1e-13 * scale => positive.push(column),
            _ => break,
        }
        loop {
            let chosen = a.select_columns(&positive);
            let Some(solution) = chosen.svd(true, true).solve(b, 1e-15).ok() else {
                return x;
            };
            if solution.iter().all(|&value| value > 0.0) {
                x.fill(0.0);
                for (&column, &value) in positive.iter().zip(solution.iter()) {
                    x[column] = value;
                }
                break;
            }
            // Moves towards the solution until an unknown becomes zero, and takes that unknown out.
            let step = (positive.iter().zip(solution.iter()))
                .filter(|(_, value)| **value <= 0.0)
                .map(|(&column, &value)| x[column] / (x[column] - value))
                .fold(1.0, f64::min);
            for (&column, &value) in positive.iter().zip(solution.iter()) {
                x[column] += step * (value - x[column]);
            }
            positive.retain(|&column| x[column] > 1e-12 * x.amax());
            if positive.is_empty() {
                break;
            }
        }
    }
    x
}

//! Matrices in `f64`.

use crate::PARAMETERS;
use crate::parameters::Parameters;

/// Smallest pivot of the elimination of a symmetric matrix in `f64`: positive if and only if the matrix is.
pub fn least_pivot(matrix: &[Parameters; PARAMETERS]) -> f64 {
    let mut left = matrix.map(|row| row.map(f64::from));
    let mut least = f64::INFINITY;
    for k in 0..PARAMETERS {
        let eliminated = left[k];
        let pivot = eliminated[k];
        least = least.min(pivot);
        for row in &mut left[k + 1..] {
            let factor = row[k] / pivot;
            for (element, above) in row.iter_mut().zip(eliminated) {
                *element -= factor * above;
            }
        }
    }
    least
}

//! Fisher's information on the parameters, and the covariance that no unbiased estimate can be below.

use std::array;

use super::parameters::{PARAMETERS, Vector};

/// Information in units of the prior deviations, which scale it: they differ by many orders.
#[derive(Clone, Debug)]
pub struct Information {
    matrix: [Vector; PARAMETERS],
    deviations: Vector,
}

impl Information {
    /// That of a normal prior with this covariance.
    pub fn of_prior(covariance: &[Vector; PARAMETERS]) -> Self {
        let deviations: Vector = array::from_fn(|i| covariance[i][i].sqrt());
        let correlation = array::from_fn(|i| {
            array::from_fn(|j| covariance[i][j] / (deviations[i] * deviations[j]))
        });
        Self { matrix: inverse(correlation), deviations }
    }

    /// Adds that of a reading with a standard deviation, which changes by these slopes with the parameters.
    pub fn add(&mut self, slopes: &Vector, deviation: f64) {
        let scaled: Vector = array::from_fn(|i| slopes[i] * self.deviations[i] / deviation);
        for (row, a) in self.matrix.iter_mut().zip(scaled) {
            for (element, b) in row.iter_mut().zip(scaled) {
                *element += a * b;
            }
        }
    }

    /// The covariance of Cramér and Rao.
    pub fn covariance(&self) -> [Vector; PARAMETERS] {
        let scaled = inverse(self.matrix);
        array::from_fn(|i| {
            array::from_fn(|j| scaled[i][j] * self.deviations[i] * self.deviations[j])
        })
    }
}

/// Standard deviation of a quantity with these slopes.
pub fn deviation(covariance: &[Vector; PARAMETERS], slopes: &Vector) -> f64 {
    let rows = covariance.iter().zip(slopes);
    let sum: f64 =
        rows.map(|(row, a)| a * row.iter().zip(slopes).map(|(c, b)| c * b).sum::<f64>()).sum();
    sum.sqrt()
}

/// Inverse of a symmetric positive matrix, by elimination without exchange of rows.
fn inverse<const N: usize>(mut matrix: [[f64; N]; N]) -> [[f64; N]; N] {
    let mut inverse = array::from_fn(|i| array::from_fn(|j| f64::from(u8::from(i == j))));
    for k in 0..N {
        let pivot = matrix[k][k];
        for (left, right) in matrix[k].iter_mut().zip(&mut inverse[k]) {
            (*left, *right) = (*left / pivot, *right / pivot);
        }
        let (of_left, of_right) = (matrix[k], inverse[k]);
        for i in (0..N).filter(|i| *i != k) {
            let factor = matrix[i][k];
            for j in 0..N {
                matrix[i][j] -= factor * of_left[j];
                inverse[i][j] -= factor * of_right[j];
            }
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: `[[4, 2], [2, 3]]` has the determinant 8.
    #[test]
    fn an_inverse_is_that_of_a_known_matrix() {
        let found: [[f64; 2]; 2] = inverse([[4.0, 2.0], [2.0, 3.0]]);
        let expected = [[0.375, -0.25], [-0.25, 0.5]];
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }

    /// Independent parameters of which one is read 100 times: its variance is `1 / (1 / prior + 100 / noise²)`. Of another, which is
    /// correlated with it by a half in the prior, `1 - 0.25` of the prior variance remains at least.
    #[test]
    fn readings_of_one_parameter_leave_what_is_known_from_theory() {
        let deviations: Vector = array::from_fn(|i| 10f64.powi(i as i32 % 7 - 3));
        let mut prior = array::from_fn(|i| {
            array::from_fn(|j| if i == j { deviations[i].powi(2) } else { 0.0 })
        });
        prior[2][5] = 0.5 * deviations[2] * deviations[5];
        prior[5][2] = prior[2][5];
        let mut information = Information::of_prior(&prior);
        let mut slopes = [0.0; PARAMETERS];
        slopes[2] = 3.0;
        for _ in 0..100 {
            information.add(&slopes, 0.2);
        }
        let covariance = information.covariance();
        let read = 1.0 / (deviations[2].powi(-2) + 100.0 * 9.0 / 0.04);
        assert!((covariance[2][2] / read - 1.0).abs() < 1e-9);
        let left = 0.75 + 0.25 * read / deviations[2].powi(2);
        assert!((covariance[5][5] / deviations[5].powi(2) / left - 1.0).abs() < 1e-9);
        assert!((covariance[0][0] / deviations[0].powi(2) - 1.0).abs() < 1e-9);
        let mut both = [0.0; PARAMETERS];
        (both[0], both[1]) = (2.0, -1.0);
        let expected = (4.0 * deviations[0].powi(2) + deviations[1].powi(2)).sqrt();
        assert!((deviation(&covariance, &both) / expected - 1.0).abs() < 1e-9);
    }
}

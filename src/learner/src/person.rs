//! What is stored of a finger that was learnt, and how it becomes the prior of another day.

use crate::estimate::Estimate;
use crate::parameters::{
    AIR, FIRST_COMPONENT, Place, RESISTANCE, SECOND_COMPONENT, Scale, clamped,
};

/// The parameters that are stored. The others belong to the device: the error of its skin thermistor, and its sensor's lag.
const STORED: [usize; 4] = [FIRST_COMPONENT, SECOND_COMPONENT, AIR, RESISTANCE];
/// Units of a stored parameter per prior deviation.
const UNITS_PER_DEVIATION: f32 = 4096.0;
/// Units of a correlation of 1.
const UNITS_OF_CORRELATION: f32 = i8::MAX as f32;
/// Least pivot of the matrix of correlations; rounding and damaged bytes can make it smaller, and then all correlations shrink.
const PIVOT_MIN: f32 = 1e-3;
const SHRINKING: f32 = 0.9;
/// After so many, no correlation is above 0.29, so that the matrix has a dominant diagonal.
const SHRINKINGS_MAX: u32 = 12;

type Matrix = [[f32; STORED.len()]; STORED.len()];

/// A finger that was learnt, to begin with on another day or device:
///
/// | bytes | content |
/// |---|---|
/// | 8 | components 1 and 2, changes of air and contact resistance: `i16`, little-endian, 1/4096 prior deviation |
/// | 4 | their deviations: `u8`, 2^(-n/32) prior deviations, rounded up |
/// | 6 | their correlations, by rows above the diagonal: `i8`, 1/127 |
/// | 1 | contacts of 8 s or more from which it was learnt, at most 255 |
/// | 1 | place before the contacts: 0 in air, otherwise on a pad |
///
/// Any bytes are a finger within the limits of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonPrior(pub [u8; Self::BYTES]);

impl PersonPrior {
    /// Length.
    pub const BYTES: usize = 20;

    /// Components 1 and 2, changes of air and contact resistance, in prior deviations.
    #[must_use]
    pub fn parameters(&self) -> [f32; STORED.len()] {
        let (integers, _) = self.0.as_chunks::<2>();
        let mut parameters = [0.0; STORED.len()];
        for (parameter, integer) in parameters.iter_mut().zip(integers) {
            *parameter = f32::from(i16::from_le_bytes(*integer)) / UNITS_PER_DEVIATION;
        }
        parameters
    }

    /// Their deviations, in prior deviations.
    #[must_use]
    pub fn deviations(&self) -> [f32; STORED.len()] {
        let [.., a, b, c, d, _, _, _, _, _, _, _, _] = self.0;
        [a, b, c, d].map(deviation)
    }

    /// Number of contacts of 8 s or more from which it was learnt, at most 255.
    #[must_use]
    pub const fn contacts(&self) -> u8 {
        let [.., contacts, _] = self.0;
        contacts
    }

    /// Where the finger was before these contacts.
    #[must_use]
    pub const fn place(&self) -> Place {
        match self.0 {
            [.., 0] => Place::Air,
            _ => Place::Pad,
        }
    }

    /// What is to be stored of an estimate.
    pub(crate) fn new(estimate: &Estimate, contacts: u8, place: Place) -> Self {
        let levels = STORED.map(|i| level(estimate.covariance[i][i]));
        let deviations = levels.map(deviation);
        let parameters =
            STORED.map(|i| rounded(estimate.parameters[i] * UNITS_PER_DEVIATION) as i16);
        let [[a, b], [c, d], [e, f], [g, h]] = parameters.map(i16::to_le_bytes);
        let [ab, ac, ad, bc, bd, cd] =
            [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(row, column)| {
                let covariance = estimate.covariance[STORED[row]][STORED[column]];
                let correlation = covariance / (deviations[row] * deviations[column]);
                (rounded(correlation * UNITS_OF_CORRELATION) as i8).to_le_bytes()
            });
        let [i, j, k, l] = levels;
        Self([
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
            i,
            j,
            k,
            l,
            ab[0],
            ac[0],
            ad[0],
            bc[0],
            bd[0],
            cd[0],
            contacts,
            place as u8,
        ])
    }

    /// The estimate with which to begin at this place; at another one than that of the record nothing is known of the air.
    pub(crate) fn estimate(&self, place: Place, scale: &Scale) -> Estimate {
        let mut estimate = Estimate::PRIOR;
        let (parameters, deviations) = (self.parameters(), self.deviations());
        let correlations = self.positive_correlations();
        let is_known = |index: usize| index != AIR || place == self.place();
        for (row, &i) in STORED.iter().enumerate() {
            if !is_known(i) {
                continue;
            }
            estimate.parameters[i] = clamped(parameters[row], scale.low[i], scale.high[i]);
            for (column, &j) in STORED.iter().enumerate().filter(|(_, j)| is_known(**j)) {
                // The product of the two deviations does not depend on their order.
                estimate.covariance[i][j] =
                    deviations[row] * deviations[column] * correlations[row][column];
            }
        }
        estimate
    }

    /// The correlations, shrunk until their matrix is positive.
    fn positive_correlations(&self) -> Matrix {
        let [.., ab, ac, ad, bc, bd, cd, _, _] =
            (self.0).map(|byte| clamped(f32::from(byte as i8) / UNITS_OF_CORRELATION, -1.0, 1.0));
        let mut matrix = [
            [1.0, ab, ac, ad],
            [ab, 1.0, bc, bd],
            [ac, bc, 1.0, cd],
            [ad, bd, cd, 1.0],
        ];
        for _ in 0..SHRINKINGS_MAX {
            if is_positive(&matrix) {
                break;
            }
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, element) in row.iter_mut().enumerate() {
                    if i != j {
                        *element *= SHRINKING;
                    }
                }
            }
        }
        matrix
    }
}

/// Whether all pivots of the elimination of a symmetric matrix are large enough.
fn is_positive(matrix: &Matrix) -> bool {
    let mut left = *matrix;
    for k in 0..left.len() {
        let eliminated = left[k];
        let pivot = eliminated[k];
        if pivot < PIVOT_MIN {
            return false;
        }
        for row in left.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot;
            for (element, above) in row.iter_mut().zip(&eliminated) {
                *element -= factor * above;
            }
        }
    }
    true
}

/// The deviation 2^(-level/32).
fn deviation(level: u8) -> f32 {
    /// 2^(-n/32) for the bits of n, from the lowest.
    const FACTORS: [f32; 8] = {
        // 2^(-1/32).
        let (mut factors, mut factor) = ([0.0; 8], 0.978_572_062_087_700_1);
        let mut bit = 0;
        while bit < 8 {
            factors[bit] = factor as f32;
            factor *= factor;
            bit += 1;
        }
        factors
    };
    let bits = FACTORS.iter().enumerate();
    bits.filter(|(bit, _)| level >> bit & 1 == 1)
        .fold(1.0, |product, (_, factor)| product * factor)
}

/// The largest level whose deviation is not less than that of this variance; 0 for variances above 1.
fn level(variance: f32) -> u8 {
    (0..8).rev().fold(0, |level, bit| {
        let larger = level | 1 << bit;
        if deviation(larger) * deviation(larger) >= variance {
            larger
        } else {
            level
        }
    })
}

/// The value so that a cast, which truncates, rounds to the nearest integer.
fn rounded(value: f32) -> f32 {
    if value < 0.0 {
        value - 0.5
    } else {
        value + 0.5
    }
}

#[cfg(test)]
mod tests;

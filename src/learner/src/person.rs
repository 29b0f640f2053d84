//! A finger that was learnt, as it is stored, and as the prior of later contacts.

use crate::estimate::Estimate;
use crate::parameters::{
    AIR, FIRST_COMPONENT, PARAMETERS, PlaceBeforeContact, RESISTANCE, SECOND_COMPONENT, Scale,
    clamped,
};

/// The parameters that are stored. The others belong to the device: the error of its skin thermistor, and its sensor's lag.
const STORED: [usize; 4] = [FIRST_COMPONENT, SECOND_COMPONENT, AIR, RESISTANCE];

/// Whether a parameter is one of [`STORED`]. Loops over that table would be unrolled, with checks of indices.
const fn is_stored(index: usize) -> bool {
    matches!(index, FIRST_COMPONENT | SECOND_COMPONENT | AIR | RESISTANCE)
}

/// Units of a stored parameter per prior deviation.
const UNITS_PER_DEVIATION: f32 = 4096.0;
/// Units of a correlation of 1, so that no byte is beyond -1 to 1.
const UNITS_OF_CORRELATION: f32 = 128.0;
/// Least pivot of the matrix of correlations; rounding and damaged bytes can make it smaller, and then all correlations shrink.
const PIVOT_MIN: f32 = 1e-3;
const SHRINKING: f32 = 0.9;
/// After so many, no correlation is above 0.29, so that the matrix has a dominant diagonal.
const SHRINKINGS_MAX: u32 = 12;

/// A finger that was learnt, as the prior on another day or device:
///
/// | bytes | content |
/// |---|---|
/// | 8 | components 1 and 2, changes of air and contact resistance: `i16`, little-endian, 1/4096 prior deviation |
/// | 4 | their deviations, in prior deviations, rounded up: `u8` 32 q + r for 2^-q (1 - r/64) |
/// | 6 | their correlations, by rows above the diagonal: `i8`, 1/128 |
/// | 1 | contacts of 8 s or more from which it was learnt, at most 255 |
/// | 1 | place before the contacts: 0 in air, otherwise on a pad |
///
/// Any bytes are a finger within the limits of the parameters. Aligned, so that it is copied by words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(4))]
pub struct PersonPrior(pub [u8; Self::BYTES]);

impl PersonPrior {
    /// Length.
    pub const BYTES: usize = 20;

    /// Components 1 and 2, changes of air and contact resistance, in prior deviations.
    pub fn parameters(&self) -> [f32; STORED.len()] {
        let (integers, _) = self.0.as_chunks::<2>();
        let mut parameters = [0.0; STORED.len()];
        for (parameter, integer) in parameters.iter_mut().zip(integers) {
            *parameter = f32::from(i16::from_le_bytes(*integer)) / UNITS_PER_DEVIATION;
        }
        parameters
    }

    /// Their deviations, in prior deviations.
    pub fn deviations(&self) -> [f32; STORED.len()] {
        let mut deviations = [0.0; STORED.len()];
        let levels = self.0.iter().skip(2 * STORED.len());
        for (one, level) in deviations.iter_mut().zip(levels) {
            *one = deviation(*level);
        }
        deviations
    }

    /// Number of contacts of 8 s or more from which it was learnt, at most 255.
    pub const fn contacts(&self) -> u8 {
        let [.., contacts, _] = self.0;
        contacts
    }

    /// Where the finger was before these contacts.
    pub const fn place(&self) -> PlaceBeforeContact {
        match self.0 {
            [.., 0] => PlaceBeforeContact::Air,
            _ => PlaceBeforeContact::Pad,
        }
    }

    /// What is to be stored of an estimate.
    #[inline(never)]
    pub(crate) fn new(estimate: &Estimate, contacts: u8, place: PlaceBeforeContact) -> Self {
        let mut bytes = [0; Self::BYTES];
        let (parameters, rest) = bytes.split_at_mut(2 * STORED.len());
        let (levels, rest) = rest.split_at_mut(STORED.len());
        let (parameters, _) = parameters.as_chunks_mut();
        let (mut parameters, mut levels) = (parameters.iter_mut(), levels.iter_mut());
        let mut rest = rest.iter_mut();
        for i in (0..PARAMETERS).filter(|i| is_stored(*i)) {
            let parameter = estimate.parameters[i] * UNITS_PER_DEVIATION;
            if let Some(bytes) = parameters.next() {
                *bytes = (rounded(parameter) as i16).to_le_bytes();
            }
            let own = level(estimate.covariance[i][i]);
            if let Some(byte) = levels.next() {
                *byte = own;
            }
            for j in (i + 1..PARAMETERS).filter(|j| is_stored(*j)) {
                let other = level(estimate.covariance[j][j]);
                let largest = deviation(own) * deviation(other);
                let correlation = estimate.covariance[i][j] / largest * UNITS_OF_CORRELATION;
                if let Some(byte) = rest.next() {
                    *byte = rounded(correlation) as i8 as u8;
                }
            }
        }
        for (byte, value) in rest.zip([contacts, place as u8]) {
            *byte = value;
        }
        Self(bytes)
    }

    /// The prior of a finger at this place. At another place than that of the record nothing is known of the air's flux.
    #[inline(never)]
    pub(crate) fn estimate(&self, place: PlaceBeforeContact, scale: &Scale) -> Estimate {
        let mut estimate = Estimate::PRIOR;
        let mut deviations = [1.0; PARAMETERS];
        let known = self.parameters().into_iter().zip(self.deviations());
        let stored = (0..PARAMETERS).filter(|i| is_stored(*i));
        for (i, (parameter, deviation)) in stored.zip(known) {
            estimate.parameters[i] = clamped(parameter, scale.low[i], scale.high[i]);
            estimate.covariance[i][i] = deviation * deviation;
            deviations[i] = deviation;
        }
        let correlations = self.positive_correlations();
        let mut correlations = correlations.iter();
        for i in (0..PARAMETERS).filter(|i| is_stored(*i)) {
            for j in (i + 1..PARAMETERS).filter(|j| is_stored(*j)) {
                let correlation = correlations.next().unwrap_or(&0.0);
                let covariance = correlation * deviations[i] * deviations[j];
                estimate.covariance[i][j] = covariance;
                estimate.covariance[j][i] = covariance;
            }
        }
        if place != self.place() {
            estimate.parameters[AIR] = Estimate::PRIOR.parameters[AIR];
            estimate.covariance[AIR] = Estimate::PRIOR.covariance[AIR];
            for (row, prior) in (estimate.covariance.iter_mut()).zip(&Estimate::PRIOR.covariance) {
                row[AIR] = prior[AIR];
            }
        }
        estimate
    }

    /// The correlations, shrunk until their matrix is positive.
    fn positive_correlations(&self) -> Correlations {
        let mut correlations = [0.0; 6];
        let bytes = self.0.iter().skip(3 * STORED.len());
        for (correlation, byte) in correlations.iter_mut().zip(bytes) {
            *correlation = f32::from(*byte as i8) / UNITS_OF_CORRELATION;
        }
        for _ in 0..SHRINKINGS_MAX {
            if is_positive(&correlations) {
                break;
            }
            for correlation in &mut correlations {
                *correlation *= SHRINKING;
            }
        }
        correlations
    }
}

/// By rows above the diagonal.
type Correlations = [f32; 6];

/// Whether all pivots of the elimination are large enough.
fn is_positive(&[ab, ac, ad, bc, bd, cd]: &Correlations) -> bool {
    let b = 1.0 - ab * ab;
    if b < PIVOT_MIN {
        return false;
    }
    let (bc, bd) = (bc - ab * ac, bd - ab * ad);
    let c = 1.0 - ac * ac - bc * bc / b;
    if c < PIVOT_MIN {
        return false;
    }
    let cd = cd - ac * ad - bc * bd / b;
    1.0 - ad * ad - bd * bd / b - cd * cd / c >= PIVOT_MIN
}

/// The deviation 2^-q (1 - r/64) of a level 32 q + r: the number of `f32` that many 32nds of an octave below 1.
const fn deviation(level: u8) -> f32 {
    f32::from_bits(1f32.to_bits() - ((level as u32) << (f32::MANTISSA_DIGITS - 1 - 5)))
}

/// The largest level whose deviation is not less than that of this variance; 0 for variances above 1.
#[inline(never)]
fn level(variance: f32) -> u8 {
    (0..8).rev().fold(0, |level, bit| {
        let larger = level | 1 << bit;
        if deviation(larger) * deviation(larger) >= variance { larger } else { level }
    })
}

/// The value so that a cast, which truncates, rounds to the nearest integer.
fn rounded(value: f32) -> f32 {
    if value < 0.0 { value - 0.5 } else { value + 0.5 }
}

#[cfg(test)]
mod tests;

//! Recursive least squares: parameters and their covariance.

use crate::parameters::{PARAMETERS, PRIOR, Parameters, RESISTANCE, Scale, clamped};
use crate::regressors::Measurement;
use crate::signals::dot;

/// Largest variance, in prior variances.
pub const VARIANCE_MAX: f32 = 1.25;
/// Added to each variance by an update: forgets slowly, and is a hundred times the rounding of an update, so that the
/// covariance stays positive.
const VARIANCE_ADDED: f32 = 1e-5;
/// Standard deviations by which a finger changes from one contact to the next: components (1), air (relative), skin (K), resistance
/// (relative), lag (relative).
const DEVIATIONS_BETWEEN_CONTACTS: Parameters = [0.05, 0.05, 0.1, 0.02, 0.07, 0.01];

/// Parameters and covariance, in prior deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The parameters.
    pub parameters: Parameters,
    /// Their covariance, symmetric.
    pub covariance: [Parameters; PARAMETERS],
}

impl Estimate {
    /// What is known before the first contact.
    pub const PRIOR: Self = {
        let mut covariance = [[0.0; PARAMETERS]; PARAMETERS];
        let mut i = 0;
        while i < PARAMETERS {
            covariance[i][i] = 1.0;
            i += 1;
        }
        Self { parameters: PRIOR, covariance }
    };

    /// Variances.
    pub fn variances(&self) -> Parameters {
        let mut variances = [0.0; PARAMETERS];
        for (i, (variance, row)) in variances.iter_mut().zip(&self.covariance).enumerate() {
            *variance = row[i];
        }
        variances
    }

    /// Raises the variances by what may have changed since the last contact.
    pub fn widen(&mut self, scale: &Scale) {
        let deviations = DEVIATIONS_BETWEEN_CONTACTS.iter().zip(&scale.deviations);
        for (i, (row, (change, prior))) in self.covariance.iter_mut().zip(deviations).enumerate() {
            let deviation = change / prior;
            row[i] = with_added(row[i], deviation * deviation);
        }
    }

    /// Raises the variance of the contact resistance, in prior variances.
    pub fn widen_resistance(&mut self, added: f32) {
        let variance = &mut self.covariance[RESISTANCE][RESISTANCE];
        *variance = with_added(*variance, added);
    }

    /// Updates by a measurement whose error has this variance, K². Returns the squared innovation over its variance; none if
    /// the arithmetic has failed.
    pub fn update(
        &mut self,
        measurement: &Measurement,
        variance_k2: f32,
        scale: &Scale,
    ) -> Option<f32> {
        let h = &measurement.regressors;
        let mut ph = [0.0; PARAMETERS];
        for (one, row) in ph.iter_mut().zip(&self.covariance) {
            *one = dot(row, h);
        }
        let s = variance_k2 + dot(&ph, h);
        // Neither for a sum that rounding has made negative nor for one that is not a number.
        if !(s >= variance_k2 && s < f32::MAX) {
            return None;
        }
        let inverse = 1.0 / s;
        let innovation_k = measurement.residual_k - dot(h, &self.parameters);
        let step = innovation_k * inverse;
        let limits = scale.low.iter().zip(&scale.high);
        for ((parameter, ph), (low, high)) in self.parameters.iter_mut().zip(&ph).zip(limits) {
            *parameter = clamped(*parameter + ph * step, *low, *high);
        }
        for (i, (row, ph_i)) in self.covariance.iter_mut().zip(&ph).enumerate() {
            // The product of the two does not depend on their order, so the matrix stays symmetric to the last bit.
            for (element, ph_j) in row.iter_mut().zip(&ph) {
                *element -= ph_i * ph_j * inverse;
            }
            row[i] = with_added(row[i], VARIANCE_ADDED);
        }
        let ratio = innovation_k * step;
        (ratio < f32::MAX).then_some(ratio)
    }
}

/// A variance to which something is added, within its limits.
fn with_added(variance: f32, added: f32) -> f32 {
    clamped(variance + added, VARIANCE_ADDED, VARIANCE_MAX)
}

#[cfg(test)]
mod tests;

//! What has been learnt, in fixed point.

use contact_model::fixed_point::{Celsius, WEIGHTS};
use fixed::traits::Fixed;
use fixed::types::{I2F30, I4F28, U2F30, U4F28, U10F22};

use crate::estimate::Estimate;
use crate::parameters::{AIR, PARAMETERS, RESISTANCE, SKIN, Scale};
use crate::person::PersonPrior;
use crate::signals::BankOutput;
use crate::trust::Trust;

/// Differences from the applied finger below which a new one is not applied.
const WEIGHT_TOLERANCE: U2F30 = U2F30::lit("0x.002");
const AIR_TOLERANCE: U4F28 = U4F28::lit("0x.008");
const SKIN_TOLERANCE_K: U10F22 = U10F22::lit("0.0005");
const RESISTANCE_TOLERANCE: U4F28 = U4F28::lit("0x.002");

/// The finger, to be applied ten ticks after its input was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LearnerOutput {
    /// Number of the input's window.
    pub sequence: u16,
    /// Counts the changes of what follows, but for the trust.
    pub revision: u16,
    /// Weights of the tissue over those of the mean finger, 0.4 to 2, for `TissueWeights`.
    pub weights: [I2F30; WEIGHTS],
    /// Flux that the air took before contact over that from the assumed finger, less 1; -2.5 to 2.5.
    pub air_flux_deviation: I4F28,
    /// Skin before contact less what its thermistor says, -0.3 to 0.3 K.
    pub skin_offset_k: Celsius,
    /// Factor on the nominal contact resistance, 0.4 to 2.5.
    pub resistance_factor: I4F28,
    /// What this is worth.
    pub trust: Trust,
    /// Components of the tissue, changes of air, skin, contact resistance and lag, in prior deviations.
    pub parameters: [I4F28; PARAMETERS],
    /// Their variances, in prior variances: above 0, at most 1.25.
    pub variances: [I2F30; PARAMETERS],
    /// What to store of the finger; only in the first window after a contact of 8 s or more that was trusted to its end.
    pub person: Option<PersonPrior>,
}

/// A result in fixed point. The cast saturates, and takes what is not a number for 0.
fn to_fixed<T: Fixed<Bits = i32>>(value: f32) -> T {
    T::from_bits((value * (1u32 << T::FRAC_NBITS) as f32) as i32)
}

/// Results in fixed point. In a loop: `map` unrolls.
fn all_to_fixed<T: Fixed<Bits = i32>, const N: usize>(values: &[f32; N]) -> [T; N] {
    let mut all = [T::ZERO; N];
    for (fixed, value) in all.iter_mut().zip(values) {
        *fixed = to_fixed(*value);
    }
    all
}

impl LearnerOutput {
    /// The mean finger, before the first output.
    pub(crate) const MEAN: Self = Self {
        sequence: 0,
        revision: 0,
        weights: [I2F30::ONE; WEIGHTS],
        air_flux_deviation: I4F28::ZERO,
        skin_offset_k: Celsius::ZERO,
        resistance_factor: I4F28::ONE,
        trust: Trust::Learning,
        parameters: [I4F28::ZERO; PARAMETERS],
        variances: [I2F30::ZERO; PARAMETERS],
        person: None,
    };

    /// What is known, before it has a window's number, trust and person. Parameters and variances are within their limits.
    pub fn new(revision: u16, estimate: &Estimate, weights: &BankOutput, scale: &Scale) -> Self {
        let parameters = &estimate.parameters;
        let change = |index: usize| parameters[index] * scale.deviations[index];
        Self {
            sequence: 0,
            revision,
            weights: all_to_fixed(weights),
            air_flux_deviation: to_fixed(change(AIR)),
            skin_offset_k: to_fixed(change(SKIN)),
            resistance_factor: to_fixed(1.0 + change(RESISTANCE)),
            trust: Trust::Learning,
            parameters: all_to_fixed(parameters),
            variances: all_to_fixed(&estimate.variances()),
            person: None,
        }
    }

    /// Whether the finger differs too little to be applied anew: by at most some 2 mK of the set-point.
    pub fn is_nearly(&self, other: &Self) -> bool {
        let weights = self.weights.iter().zip(&other.weights);
        weights.fold(true, |near, (own, other)| near & (own.abs_diff(*other) <= WEIGHT_TOLERANCE))
            && self.air_flux_deviation.abs_diff(other.air_flux_deviation) <= AIR_TOLERANCE
            && self.skin_offset_k.abs_diff(other.skin_offset_k) <= SKIN_TOLERANCE_K
            && self.resistance_factor.abs_diff(other.resistance_factor) <= RESISTANCE_TOLERANCE
    }

    /// Goes one step towards the mean finger, for a window without an answer of the learner: to a twentieth in ten windows, as the
    /// learner goes there after a distrust. Returns whether anything has changed.
    pub fn approach_mean(&mut self) -> bool {
        let mut has_changed = false;
        for weight in &mut self.weights {
            has_changed |= approach(weight, I2F30::ONE);
        }
        has_changed
            | approach(&mut self.air_flux_deviation, I4F28::ZERO)
            | approach(&mut self.skin_offset_k, Celsius::ZERO)
            | approach(&mut self.resistance_factor, I4F28::ONE)
    }
}

/// Reduces the distance from the mean value to three quarters, and one of three units or less to 0. Returns whether it has changed.
fn approach<T: Fixed<Bits = i32>>(value: &mut T, mean: T) -> bool {
    let next = approached(value.to_bits(), mean.to_bits());
    let has_changed = next != value.to_bits();
    *value = T::from_bits(next);
    has_changed
}

#[inline(never)]
const fn approached(value: i32, mean: i32) -> i32 {
    mean.saturating_add(value.saturating_sub(mean) / 4 * 3)
}

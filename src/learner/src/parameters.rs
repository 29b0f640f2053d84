//! The six parameters of a finger: what is known of them before, and their limits.

use contact_model::finger::{COMPONENT_MEANS, COMPONENTS, MEAN};
use contact_model::fixed_point::{TissueWeights, WEIGHTS};
use contact_model::impedance::Relaxation;
use fixed::types::I2F30;

use crate::signals::{BankOutput, RELAXATION_COUNT};

/// Number of parameters: two components of the tissue, film of air, skin temperature, contact resistance, and last the sensor's
/// lag.
pub const PARAMETERS: usize = 6;
/// One value per parameter.
pub type Parameters = [f32; PARAMETERS];

/// Index of the first component.
pub const FIRST_COMPONENT: usize = 0;
/// Index of the second component.
pub const SECOND_COMPONENT: usize = 1;
/// Index of the film of air.
pub const AIR: usize = 2;
/// Index of the skin temperature.
pub const SKIN: usize = 3;
/// Index of the contact resistance.
pub const RESISTANCE: usize = 4;

/// The mean finger's relaxations with a rate. Its integrator is left out: it adds 1.4 mK per kW/m² and 10 s.
pub const RELAXATIONS: &[Relaxation] = {
    let (integrator, others) = MEAN.impedance.relaxations.split_at(1);
    assert!(integrator[0].rate_1_s == 0.0 && others.len() == RELAXATION_COUNT);
    others
};

/// Weights of the mean finger, m² K/J and m² K/W.
pub const MEAN_WEIGHTS: BankOutput = {
    let mut weights = [MEAN.impedance.direct_m2k_w as f32; WEIGHTS];
    let mut k = 0;
    while k < RELAXATION_COUNT {
        weights[k] = RELAXATIONS[k].gain_m2k_j as f32;
        k += 1;
    }
    weights
};

/// Deviations of the weights per unit of each component, over the mean finger's.
pub const RELATIVE_COMPONENTS: [BankOutput; 2] = {
    let mut all = [[0.0; WEIGHTS]; 2];
    let mut k = 0;
    while k < WEIGHTS {
        all[0][k] = COMPONENTS[0][k] as f32;
        all[1][k] = COMPONENTS[1][k] as f32;
        k += 1;
    }
    all
};

/// Parameters before anything is learnt, in prior deviations: the mean of the simulated fingers. All zero is the mean finger.
pub const PRIOR: Parameters =
    [COMPONENT_MEANS[0] as f32, COMPONENT_MEANS[1] as f32, 0.0, 0.0, 0.0, 0.0];

/// Where the finger is before each contact, on which the heat that its skin loses there depends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceBeforeContact {
    /// In air.
    Air,
    /// On an insulating pad.
    Pad,
}

/// Prior deviations of the parameters, and limits in units of these deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Prior deviations: 1, 1, relative, K, relative, relative.
    pub deviations: Parameters,
    /// Least values.
    pub low: Parameters,
    /// Largest values.
    pub high: Parameters,
}

/// Limits of the components (the second one also represents strong perfusion of the dermis: 5.6 in a finger of scenario G), of the
/// relative change of the air's flux (below -1 for a finger on a pad whose blood the force stops), of the error of the skin's
/// thermistor, K, of the relative change of the contact resistance, and of that of the lag.
const LIMITS: [(f32, f32); PARAMETERS] =
    [(-3.5, 3.5), (-7.0, 7.0), (-2.5, 2.5), (-0.3, 0.3), (0.4 - 1.0, 2.5 - 1.0), (-0.3, 0.3)];

impl Scale {
    /// For a finger at this place, and a sensor whose lag has this relative deviation.
    pub const fn new(place: PlaceBeforeContact, lag_deviation: f32) -> Self {
        let air = match place {
            PlaceBeforeContact::Air => 0.33,
            PlaceBeforeContact::Pad => 0.48,
        };
        let deviations = [1.0, 1.0, air, 0.05, 0.45, lag_deviation];
        let (mut low, mut high) = ([0.0; PARAMETERS], [0.0; PARAMETERS]);
        let mut i = 0;
        while i < PARAMETERS {
            low[i] = LIMITS[i].0 / deviations[i];
            high[i] = LIMITS[i].1 / deviations[i];
            i += 1;
        }
        Self { deviations, low, high }
    }
}

/// Least and largest relative weight of a finger: that which the device applies, and one below the range of its type.
pub const WEIGHT_LIMITS: (f32, f32) =
    (TissueWeights::MIN.to_bits() as f32 / (1u32 << I2F30::FRAC_NBITS) as f32, 1.999);

/// Relative weights of the finger with these parameters.
pub fn relative_weights(parameters: &Parameters) -> BankOutput {
    let [first, second] = &RELATIVE_COMPONENTS;
    let mut weights = [1.0; WEIGHTS];
    for ((weight, first), second) in weights.iter_mut().zip(first).zip(second) {
        let sum = 1.0 + parameters[FIRST_COMPONENT] * first + parameters[SECOND_COMPONENT] * second;
        *weight = clamped(sum, WEIGHT_LIMITS.0, WEIGHT_LIMITS.1);
    }
    weights
}

/// The value within limits; the low one for what is not a number.
#[inline(never)]
pub fn clamped(value: f32, low: f32, high: f32) -> f32 {
    if value > high {
        high
    } else if value >= low {
        value
    } else {
        low
    }
}

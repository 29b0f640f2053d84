//! The mean finger's tissue with other weights of its relaxations.

use fixed::types::{I0F32, I2F30, I12F20};

use super::{Body, FingerBody};
use crate::fixed_point::half_space::inverse;

/// Number of weights of the mean finger's tissue: of its relaxations from the slowest to the fastest, without the integrator,
/// and of its direct term.
pub const WEIGHTS: usize = 9;

/// Relative weights of the mean finger's tissue, in the order of [`crate::finger::COMPONENTS`]: the gains of a finger over
/// those of [`crate::finger::MEAN`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TissueWeights([I2F30; WEIGHTS]);

/// Parts of one weight in the responses of the tissue to a scaled flux of 1, at weight 1.
struct Part {
    /// Of the slow relaxations one tick later, over the scale of the states.
    slow_input_gain: i32,
    /// At the end of the flux's tick, in units of 2^-[`TICK_BITS`].
    tick_gain: i32,
    /// After a constant flux of [`super::MATCH_HORIZON_TICKS`], in units of 2^-[`HORIZON_BITS`].
    horizon_gain: i32,
}

const TICK_BITS: u32 = 28;
const HORIZON_BITS: u32 = 26;

const fn part([slow_input_gain, tick_gain, horizon_gain]: [i32; 3]) -> Part {
    Part { slow_input_gain, tick_gain, horizon_gain }
}

/// Parts of the integrator, which keeps weight 1.
const INTEGRATOR: Part = part([5654, 1414, 7068]);
/// Parts of the other weights, for ticks of 1 ms.
const PARTS: [Part; WEIGHTS] = [
    part([4227480, 1056874, 5284175]),
    part([2854161, 713578, 3566083]),
    part([11547703, 2887562, 14407617]),
    part([16098521, 4027987, 19981286]),
    part([37856505, 9496959, 45957110]),
    part([0, 21307114, 92073626]),
    part([0, 52209618, 134012229]),
    part([0, 155497249, 86159300]),
    part([0, 125487267, 31371817]),
];

/// Scale of the states over that of the mean finger: gains of weights below 2 keep the range of their type.
const SCALE: i32 = 2;

impl TissueWeights {
    /// Least weight. The weights of the simulated fingers are above 0.67.
    pub const MIN: I2F30 = I2F30::lit("0.4");
    /// The weights of the mean finger.
    pub const MEAN: Self = Self([I2F30::ONE; WEIGHTS]);

    /// The given weights, those below [`Self::MIN`] raised to it.
    pub fn at_least_min(weights: [I2F30; WEIGHTS]) -> Self {
        Self(weights.map(|weight| weight.max(Self::MIN)))
    }

    /// The weights.
    pub const fn get(&self) -> &[I2F30; WEIGHTS] {
        &self.0
    }

    /// The mean finger's tissue with these weights, for ticks of 1 ms. Its gains have the error of their resolution.
    pub fn tissue(&self) -> Body {
        let mut body = FingerBody::MEAN.tissue;
        body.state_scale *= SCALE;
        let scaled = |gain: I0F32, weight: I2F30| {
            let bits = i64::from(gain.to_bits()) * i64::from(weight.to_bits());
            let shift = I2F30::FRAC_NBITS + SCALE.ilog2();
            I0F32::from_bits(((bits + (1 << shift >> 1)) >> shift) as i32)
        };
        let slow = body.slow.iter_mut().map(|one| &mut one.input_gain);
        let fast = body.fast.iter_mut().map(|one| &mut one.input_gain);
        let slow = slow.take(body.slow_count);
        let weights = core::iter::once(I2F30::ONE).chain(self.0);
        for (gain, weight) in slow.chain(fast).zip(weights) {
            *gain = scaled(*gain, weight);
        }

        let sum = |of: fn(&Part) -> i32| {
            let parts = PARTS.iter().zip(self.0);
            let weighted =
                parts.map(|(one, weight)| i64::from(of(one)) * i64::from(weight.to_bits()));
            (weighted.sum::<i64>() >> I2F30::FRAC_NBITS) + i64::from(of(&INTEGRATOR))
        };
        body.slow_input_gain = I0F32::from_bits(sum(|one| one.slow_input_gain) as i32);
        let tick_gain = sum(|one| one.tick_gain) >> (TICK_BITS - I12F20::FRAC_NBITS);
        body.tick_gain = I12F20::from_bits(tick_gain as i32);
        // Positive, because every weight is, and below 2^30.
        let horizon_gain = sum(|one| one.horizon_gain).max(1) as u32;
        let zeros = horizon_gain.leading_zeros();
        // 2^62 / (2^zeros gain), relative error below 2^-28.
        let inverse = u64::from(inverse(horizon_gain << zeros)) << zeros;
        const PLACES: u32 = I0F32::FRAC_NBITS + HORIZON_BITS;
        body.inverse_horizon_gain = I0F32::from_bits((inverse >> (62 - PLACES)) as i32);
        body
    }
}

#[cfg(test)]
mod tests;

//! Relaxations of a body that the host describes, in fixed point.

use core::fmt;

use fixed::types::{I0F32, I1F31, I12F20, U16F16};

use super::relaxation_bank::{
    FastRelaxation, MATCH_HORIZON_TICKS, RelaxationBank, Relaxations, SlowRelaxation, StateFactors,
    WINDOW,
};
use super::{Celsius, Fraction, saturating_product, to_fixed};
use crate::decimal::Shortest;
use crate::finger::FingerProperties;
use crate::impedance::{Impedance, Relaxation};
use crate::material::SKIN;

/// Most fast relaxations of a body.
pub const FAST_MAX: usize = 8;
/// Most slow relaxations of a body.
pub const SLOW_MAX: usize = 14;
/// Largest rate of a relaxation, per tick: a state then loses less than half of its value in a tick. A little more than
/// 690 1/s in ticks of 1 ms, because that product is rounded.
const RATE_PER_TICK_MAX: f64 = 0.691;
/// Rate, per tick, from which a relaxation is fast: in a window of 8 ticks it decays by a tenth, up to which the straight
/// line of the slow ones is good.
const FAST_RATE_PER_TICK: f64 = 0.0125;
/// Largest state of a fast relaxation, K: below the range of its type, ±512 K.
const FAST_STATE_MAX_K: f64 = 500.0;
/// Largest scaled flux, K, to which [`RelaxationBank`] limits its input.
const SCALED_FLUX_MAX_K: f64 = 32.0;
/// Bound, K, of the direct term for a scaled flux of 1 K, of twice the sum of all gains, and of each fast state: the states
/// are then shifted by at most 10 bits, and have a resolution of 0.24 mK.
const GAIN_BOUND: f64 = 1024.0;

/// An impedance that the device cannot follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyError {
    /// More fast relaxations than [`FAST_MAX`]; their number.
    TooManyFast(usize),
    /// More slow relaxations than [`SLOW_MAX`]; their number.
    TooManySlow(usize),
    /// A rate, 1/s, that is not from 0 to 690, for ticks of 1 ms.
    Rate(f64),
    /// A direct term that is negative, not a number, or too large.
    Direct {
        /// The direct term, m² K/W.
        direct_m2k_w: f64,
        /// The largest one, m² K/W.
        max_m2k_w: f64,
    },
    /// A gain that is not positive, not a number, or too large.
    Gain {
        /// The gain, m² K/J.
        gain_m2k_j: f64,
        /// The largest one of its rate beside the gains before it, m² K/J.
        max_m2k_j: f64,
        /// Index of its relaxation.
        index: usize,
    },
}

/// A value in the unit in which a host sends it, in which mm² stand for m², without the error of that conversion: with the
/// six decimals that the smallest gain has.
#[inline(never)]
fn in_mm2(value: f64) -> f64 {
    libm::round(value * 1e12) / 1e6
}

/// A largest value in the same unit: a whole number that is allowed.
#[inline(never)]
fn floor_in_mm2(value: f64) -> f64 {
    libm::floor(value * 1e6)
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyFast(count) => {
                write!(f, "{count} rates of 12.5 1/s or more; at most {FAST_MAX} are allowed")
            }
            Self::TooManySlow(count) => {
                write!(f, "{count} rates below 12.5 1/s; at most {SLOW_MAX} are allowed")
            }
            Self::Rate(value) => {
                write!(f, "rate {} 1/s; it must be 0 to 690", Shortest(*value))
            }
            Self::Direct { direct_m2k_w, max_m2k_w } => {
                let value = Shortest(in_mm2(*direct_m2k_w));
                let max = Shortest(floor_in_mm2(*max_m2k_w));
                write!(f, "direct {value} mm2K/W; it must be 0 to {max}")
            }
            Self::Gain { gain_m2k_j, max_m2k_j, index } => {
                let value = Shortest(in_mm2(*gain_m2k_j));
                let max = Shortest(floor_in_mm2(*max_m2k_j));
                write!(
                    f,
                    "gain {value} mm2K/J of relaxation {index}; above 0 to {max} is allowed at its rate beside those before it"
                )
            }
        }
    }
}

impl core::error::Error for BodyError {}

/// Relaxations of a body, for ticks of one length, with the flux scaled as for the skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Body {
    fast: [FastRelaxation; FAST_MAX],
    fast_count: usize,
    slow: [SlowRelaxation; SLOW_MAX],
    slow_count: usize,
    slow_input_gain: I0F32,
    tick_gain: I12F20,
    inverse_horizon_gain: I0F32,
    state_scale: i32,
}

impl Body {
    /// Coefficients that were computed before: of the fast relaxations input gain, decay and horizon factor, of the slow
    /// ones input gain and decay, then slow input gain, tick gain, inverse horizon gain and scale of the states.
    const fn from_bits<const FAST: usize, const SLOW: usize>(
        fast: [[i32; 3]; FAST],
        slow: [[i32; 2]; SLOW],
        [slow_input_gain, tick_gain, inverse_horizon_gain]: [i32; 3],
        state_scale: i32,
    ) -> Self {
        let mut body = Self {
            fast: [FastRelaxation::ZERO; FAST_MAX],
            fast_count: FAST,
            slow: [SlowRelaxation::ZERO; SLOW_MAX],
            slow_count: SLOW,
            slow_input_gain: I0F32::from_bits(slow_input_gain),
            tick_gain: I12F20::from_bits(tick_gain),
            inverse_horizon_gain: I0F32::from_bits(inverse_horizon_gain),
            state_scale,
        };
        let mut i = 0;
        while i < FAST {
            body.fast[i] = FastRelaxation::from_bits(fast[i]);
            i += 1;
        }
        let mut i = 0;
        while i < SLOW {
            body.slow[i] = SlowRelaxation::from_bits(slow[i]);
            i += 1;
        }
        body
    }
}

/// A body whose impedance is that of another one times a factor: a half-space is one of another effusivity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScaledBody {
    /// The other body.
    pub body: Body,
    /// The factor.
    pub factor: U16F16,
}

impl ScaledBody {
    /// The half-space whose impedance is that of the thesis's skin times `factor`, for ticks of 1 ms.
    pub const fn half_space(factor: U16F16) -> Self {
        Self { body: FingerBody::THESIS.tissue, factor }
    }

    /// Response of the surface to a scaled flux of 1 at the end of its tick.
    pub fn tick_gain(&self) -> I12F20 {
        saturating_product(self.body.tick_gain, self.factor)
    }

    /// The scaled flux that moves the surface of the other body as `flux` does that of this one.
    pub fn scaled(&self, flux: Celsius) -> Celsius {
        saturating_product(flux, self.factor)
    }
}

/// A finger in fixed point: its tissue, and the film of air on its skin before contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FingerBody {
    /// Relaxations of the tissue in contact.
    pub tissue: Body,
    /// Scaled flux from the skin into the air per kelvin between skin and room.
    pub air: Fraction,
}

impl FingerBody {
    /// The finger for ticks of `tick_s` seconds, with the flux scaled by the effusivity of the thesis's skin.
    ///
    /// # Errors
    /// The tissue's impedance has a rate or gain outside its range, or too many of them.
    pub fn new(finger: &FingerProperties, tick_s: f64) -> Result<Self, BodyError> {
        let effusivity = SKIN.effusivity();
        Ok(Self {
            tissue: Body::new(&finger.impedance, effusivity, tick_s)?,
            air: to_fixed(finger.air_w_m2k * libm::sqrt(tick_s) / effusivity),
        })
    }
}

impl FingerBody {
    /// The thesis's finger, for ticks of 1 ms.
    pub const THESIS: Self = Self {
        tissue: Body::from_bits(
            [
                [133519533, 67115811, 1592088634],
                [327191715, 336317759, 456127803],
                [973907793, 1937839267, 24042],
            ],
            [
                [2779116, 33443],
                [3927909, 386042],
                [7011152, 1781660],
                [13464488, 7125755],
                [27476765, 28146196],
                [59789914, 116960620],
            ],
            [113410214, 1139790, 850566125],
            2,
        ),
        air: Fraction::from_bits(0),
    };
    /// The mean finger, for ticks of 1 ms.
    pub const MEAN: Self = Self {
        tissue: Body::from_bits(
            [
                [170456910, 67297604, 1590788429],
                [417676942, 336498666, 455731919],
                [1243977993, 1937839267, 24042],
            ],
            [
                [11309, 0],
                [8455106, 133065],
                [5709694, 1833882],
                [23118334, 7568341],
                [32318120, 28550193],
                [76904616, 117361355],
            ],
            [145180051, 1455803, 665935421],
            2,
        ),
        air: Fraction::from_bits(1160802),
    };
    /// The mean finger on a pad before contact, for ticks of 1 ms.
    pub const MEAN_ON_PAD: Self = Self { air: Fraction::from_bits(203140), ..Self::MEAN };
}

/// State of a body.
pub type BodyState = RelaxationBank<FAST_MAX, SLOW_MAX>;
/// State of the tissue of one of the fingers in [`FingerBody`], which have fewer relaxations than a body may have.
pub type TissueState = RelaxationBank<TISSUE_FAST, TISSUE_SLOW>;
/// Factors by which a [`TissueState`] changes with the weights of its tissue.
pub type TissueStateFactors = StateFactors<TISSUE_FAST, TISSUE_SLOW>;
/// Fast relaxations of a finger's tissue.
const TISSUE_FAST: usize = 3;
/// Slow relaxations of a finger's tissue.
const TISSUE_SLOW: usize = 6;
const _: () = {
    let tissues =
        [&FingerBody::THESIS.tissue, &FingerBody::MEAN.tissue, &FingerBody::MEAN_ON_PAD.tissue];
    let mut i = 0;
    while i < tissues.len() {
        assert!(tissues[i].fast_count <= TISSUE_FAST && tissues[i].slow_count <= TISSUE_SLOW);
        i += 1;
    }
};

/// `e^x - 1` within some units of the last place (Higham, Accuracy and Stability of Numerical Algorithms, section 1.14.1): where
/// cancellation makes `e^x - 1` wrong, the logarithm is wrong by the same factor. `libm::expm1` would be 1.4 KB of code.
#[inline(never)]
fn expm1(x: f64) -> f64 {
    let exponential = libm::exp(x);
    if exponential == 1.0 { x } else { (exponential - 1.0) * x / libm::log(exponential) }
}

/// Response of a relaxation of rate `r` per tick to a unit flux of one tick, over its gain: `(1 - e^-r) / r`.
#[inline(never)]
fn mean_decay(r: f64) -> f64 {
    if r > 0.0 { -expm1(-r) / r } else { 1.0 }
}

impl Body {
    /// The relaxations of `impedance` for ticks of `tick_s` seconds; `effusivity`, J/(m² s^½ K), is that which scales the
    /// flux. In `f64`, so for set-up only.
    ///
    /// # Errors
    /// A rate or gain outside its range, or too many of them.
    #[inline]
    pub fn new(impedance: &Impedance<'_>, effusivity: f64, tick_s: f64) -> Result<Self, BodyError> {
        // A scaled flux of 1 K for one tick, J/m².
        let dose_j_m2 = effusivity * libm::sqrt(tick_s);
        let input_gain =
            |one: &Relaxation| one.gain_m2k_j * dose_j_m2 * mean_decay(one.rate_1_s * tick_s);
        let mut all_gains = 0.0;
        let (mut largest, mut tick_gain) = (0.0f64, impedance.direct_m2k_w * dose_j_m2 / tick_s);
        if !(impedance.direct_m2k_w >= 0.0 && tick_gain < GAIN_BOUND) {
            return Err(BodyError::Direct {
                direct_m2k_w: impedance.direct_m2k_w,
                max_m2k_w: GAIN_BOUND * tick_s / dose_j_m2,
            });
        }
        for (index, one) in impedance.relaxations.iter().enumerate() {
            let gain = input_gain(one);
            if !(0.0..=RATE_PER_TICK_MAX).contains(&(one.rate_1_s * tick_s)) {
                return Err(BodyError::Rate(one.rate_1_s));
            }
            // The gain of a state is below a half, and no flux takes a fast state out of its range.
            let fast_factor = if one.rate_1_s * tick_s >= FAST_RATE_PER_TICK {
                let decay = -expm1(-one.rate_1_s * tick_s);
                SCALED_FLUX_MAX_K / FAST_STATE_MAX_K / decay
            } else {
                0.0
            };
            let needed = (2.0 * (all_gains + gain)).max(gain * fast_factor);
            if !(gain > 0.0 && needed < GAIN_BOUND) {
                let unit = Relaxation { gain_m2k_j: 1.0, ..*one };
                let left = (GAIN_BOUND / 2.0 - all_gains).min(GAIN_BOUND / fast_factor);
                return Err(BodyError::Gain {
                    gain_m2k_j: one.gain_m2k_j,
                    max_m2k_j: left / input_gain(&unit),
                    index,
                });
            }
            all_gains += gain;
            largest = largest.max(needed);
            tick_gain += gain;
        }
        let state_shift = (libm::ilogb(largest.max(f64::MIN_POSITIVE)) + 1).max(0);
        let scaled = |gain: f64| to_fixed::<I0F32>(libm::ldexp(gain, -state_shift));
        let (mut horizon_gain, mut slow_input_gain) = (tick_gain, 0.0);
        let mut body = Self {
            fast: [FastRelaxation::ZERO; FAST_MAX],
            fast_count: 0,
            slow: [SlowRelaxation::ZERO; SLOW_MAX],
            slow_count: 0,
            slow_input_gain: I0F32::ZERO,
            tick_gain: to_fixed(tick_gain),
            inverse_horizon_gain: I0F32::ZERO,
            state_scale: 1 << state_shift,
        };
        let ticks = f64::from(MATCH_HORIZON_TICKS);
        for one in impedance.relaxations {
            let (r, gain) = (one.rate_1_s * tick_s, input_gain(one));
            let after_first = mean_decay(ticks * r) * ticks / mean_decay(r) - 1.0;
            horizon_gain += gain * after_first;
            if r >= FAST_RATE_PER_TICK {
                let count = body.fast_count;
                *body.fast.get_mut(count).ok_or(BodyError::TooManyFast(count + 1))? =
                    FastRelaxation {
                        input_gain: scaled(gain),
                        change: to_fixed(expm1(-r)),
                        horizon_factor: to_fixed::<I1F31>(libm::exp(-(ticks - 1.0) * r)),
                    };
                body.fast_count += 1;
            } else {
                let window = f64::from(WINDOW);
                // Mean of e^(r j) for j from 0 to 7.
                let mean = if r > 0.0 { expm1(r * window) / expm1(r) / window } else { 1.0 };
                let count = body.slow_count;
                *body.slow.get_mut(count).ok_or(BodyError::TooManySlow(count + 1))? =
                    SlowRelaxation {
                        input_gain: scaled(gain * mean),
                        decay: to_fixed(-expm1(-r * window)),
                    };
                body.slow_count += 1;
                slow_input_gain += gain * libm::exp(-r);
            }
        }
        body.slow_input_gain = scaled(slow_input_gain);
        body.inverse_horizon_gain = to_fixed(1.0 / horizon_gain);
        Ok(body)
    }

    /// The coefficients, for [`BodyState`].
    pub fn relaxations(&self) -> Relaxations<'_> {
        Relaxations {
            fast: &self.fast[..self.fast_count.min(FAST_MAX)],
            slow: &self.slow,
            slow_count: self.slow_count,
            slow_input_gain: self.slow_input_gain,
            tick_gain: self.tick_gain,
            inverse_horizon_gain: self.inverse_horizon_gain,
            state_scale: self.state_scale,
        }
    }

    /// Response of the surface to a scaled flux of 1 at the end of its tick.
    pub const fn tick_gain(&self) -> I12F20 {
        self.tick_gain
    }
}

mod weights;
pub use weights::{TissueWeights, WEIGHTS};

#[cfg(test)]
mod tests;

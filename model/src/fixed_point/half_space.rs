//! Surface temperature of a half-space under any heat flux, for contacts whose force changes or that repeat.
//!
//! Eq. 6-5 and 6-6 hold for one contact under a constant force. For any history of the heat flux `q` the
//! surface of a half-space of effusivity `e` moves by the half-order integral of `q / e`, whose transfer
//! function is `1 / sqrt(s)`. A sum of first-order modes approximates it, with rates a factor of four apart:
//!
//! ```text
//! 1 / sqrt(s) = (1 / pi) integral of e^(v/2) / (s + e^v) dv,  summed at steps of ln 4
//! ```
//!
//! An integrator stands for all slower modes, and a direct feed-through for all that settle within a tick.
//!
//! The input is the *scaled flux* `q sqrt(dt) / e` of one tick, in K; the output is the change of the surface
//! temperature since the half-space was uniform, in K.
//!
//! Two half-spaces in contact exchange the same flux: their surfaces move in opposite directions, in the
//! ratio of their effusivities. One [`HalfSpace`] therefore represents both.

mod conductance;

pub(super) use conductance::inverse;
pub use conductance::{ContactConductance, OwnResistances};

use fixed::types::{I0F32, I12F20};

use super::Celsius;
use super::body::TissueState;
use super::relaxation_bank::{FastRelaxation, RelaxationBank, Relaxations, SlowRelaxation};

/// Number of fast modes. Mode `k`, from 0, has the rate `r = 2^-(2 k + 1)` per tick and the gain
/// `g = (ln 4 / pi) (1 - e^-r) / sqrt(r)` in a tick.
const FAST: usize = 5;
/// Number of slow modes, which continue the fast ones, with the integrator as the last.
const SLOW: usize = 9;

const FAST_MODES: [FastRelaxation; FAST] = [
    FastRelaxation::from_bits([1_054_608_677, 1_689_937_949, 160_743]),
    FastRelaxation::from_bits([629_882_806, 504_671_961, 199_747_095]),
    FastRelaxation::from_bits([329_854_396, 132_142_252, 1_185_953_106]),
    FastRelaxation::from_bits([166_864_942, 33_423_701, 1_851_246_619]),
    FastRelaxation::from_bits([83_677_061, 8_380_421, 2_069_252_406]),
];

const SLOW_MODES: [SlowRelaxation; SLOW] = [
    SlowRelaxation::from_bits([41_940_820, 16_744_491]),
    SlowRelaxation::from_bits([20_947_371, 4_192_257]),
    SlowRelaxation::from_bits([10_470_809, 1_048_448]),
    SlowRelaxation::from_bits([5_235_045, 262_136]),
    SlowRelaxation::from_bits([2_617_478, 65_536]),
    SlowRelaxation::from_bits([1_308_733, 16_384]),
    SlowRelaxation::from_bits([654_366, 4_096]),
    SlowRelaxation::from_bits([327_183, 1_024]),
    // The integrator: the integral of the sum above over all slower modes, `(2 / pi) sqrt(2^-26)`.
    SlowRelaxation::from_bits([333_772, 0]),
];
/// Response to a scaled flux of 1 at the end of its tick: the sum of all `g`, and `2 / pi` for the feed-through.
const TICK_GAIN: I12F20 = I12F20::from_bits(1_240_943);

const RELAXATIONS: Relaxations<'_> = Relaxations {
    fast: &FAST_MODES,
    slow: &SLOW_MODES,
    slow_count: SLOW,
    slow_input_gain: I0F32::from_bits(83_730_349),
    tick_gain: TICK_GAIN,
    // 1 / 5.060.
    inverse_horizon_gain: I0F32::from_bits(848_800_003),
    state_scale: 1,
};

/// Change of the surface temperature of a half-space, updated tick by tick; the default is uniform.
///
/// Error of the response to a constant flux: 5 % at the first tick, 1.2 % at the second, 0.4 % from 10 to 6e4
/// ticks. After a pulse of 6e4 ticks the error is 0.07 % of the peak
/// (`cargo test -p contact-model half_space`). No input overflows: a scaled flux is limited to ±32 K, more
/// than any contact gives, and the response saturates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HalfSpace(RelaxationBank<FAST, SLOW>);

impl HalfSpace {
    /// The same state with windows that end half a window apart from this one's. Of two half-spaces that are
    /// updated together, only one then has to update its slow modes in any tick.
    pub fn staggered(&self) -> Self {
        Self(self.0.staggered(&RELAXATIONS))
    }

    /// A uniform half-space whose windows end with those of a tissue.
    pub fn uniform_in_step_with(tissue: &TissueState) -> Self {
        Self(RelaxationBank::uniform_in_step_with(tissue))
    }

    /// A uniform tissue whose windows end with those of this half-space.
    pub fn uniform_tissue(&self) -> TissueState {
        RelaxationBank::uniform_in_step_with(&self.0)
    }

    /// Change of the surface temperature at the end of the coming tick if no flux flows, K.
    pub const fn free_response(&self) -> Celsius {
        self.0.free_response()
    }

    /// Change of the surface temperature at the end of the coming tick if `scaled_flux` flows in it, K.
    pub fn response_to(&self, scaled_flux: Celsius) -> Celsius {
        self.0.response_to(scaled_flux, &RELAXATIONS)
    }

    /// Updates the state by one tick in which `scaled_flux` flows.
    #[inline(always)]
    pub fn step(&mut self, scaled_flux: Celsius) {
        self.0.step(scaled_flux, &RELAXATIONS);
    }

    /// The constant scaled flux that, added to a flux common to both, brings this surface to that of `other`
    /// within [`MATCH_HORIZON_TICKS`](super::MATCH_HORIZON_TICKS), K.
    #[inline(always)]
    pub fn scaled_flux_to_match(&self, other: &Self) -> Celsius {
        self.0.scaled_flux_to_match(&other.0, &RELAXATIONS)
    }
}

#[cfg(test)]
mod tests;

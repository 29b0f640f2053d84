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
//! Fast modes are updated every tick. Slow modes are updated once per window of [`WINDOW`] ticks, with the sum
//! of the window's fluxes; within a window their sum is extrapolated along a straight line.
//!
//! Two half-spaces in contact exchange the same flux: their surfaces move in opposite directions, in the
//! ratio of their effusivities. One [`HalfSpace`] therefore represents both.

mod conductance;

pub use conductance::ContactConductance;

use fixed::traits::LossyFrom;
use fixed::types::{I0F32, I1F31, I10F54, I11F53, I12F20};

use super::{Celsius, product};

/// Number of fast modes. Mode `k`, from 0, has the rate `r = 2^-(2 k + 1)` per tick.
const FAST: usize = 5;
/// Number of slow modes, which continue the fast ones, with the integrator as the last.
const SLOW: usize = 9;
/// Ticks between two updates of the slow modes.
const WINDOW: u32 = 8;

/// Coefficients of a fast mode, for one tick.
struct FastMode {
    /// Response to a scaled flux of 1: `g = (ln 4 / pi) (1 - e^-r) / sqrt(r)`.
    input_gain: I0F32,
    /// Fraction of the state that decays, `1 - e^-r`.
    decay: I0F32,
    /// Fraction of the state that remains at the horizon of [`HalfSpace::scaled_flux_to_match`], `e^(-19 r)`.
    horizon_factor: I1F31,
}

/// Coefficients of a slow mode, for one window.
struct SlowMode {
    /// Response to the sum of the window's scaled fluxes: `g` times the mean of `e^(r j)` for `j` from 0 to 7,
    /// because a flux decays only from its own tick to the end of the window.
    input_gain: I0F32,
    /// Fraction of the state that decays, `1 - e^(-8 r)`.
    decay: I0F32,
}

const fn fast(input_gain: i32, decay: i32, horizon_factor: i32) -> FastMode {
    FastMode {
        input_gain: I0F32::from_bits(input_gain),
        decay: I0F32::from_bits(decay),
        horizon_factor: I1F31::from_bits(horizon_factor),
    }
}

const FAST_MODES: [FastMode; FAST] = [
    fast(1_054_608_677, 1_689_937_949, 160_743),
    fast(629_882_806, 504_671_961, 199_747_095),
    fast(329_854_396, 132_142_252, 1_185_953_106),
    fast(166_864_942, 33_423_701, 1_851_246_619),
    fast(83_677_061, 8_380_421, 2_069_252_406),
];

const fn slow(input_gain: i32, decay: i32) -> SlowMode {
    SlowMode {
        input_gain: I0F32::from_bits(input_gain),
        decay: I0F32::from_bits(decay),
    }
}

const SLOW_MODES: [SlowMode; SLOW] = [
    slow(41_940_820, 16_744_491),
    slow(20_947_371, 4_192_257),
    slow(10_470_809, 1_048_448),
    slow(5_235_045, 262_136),
    slow(2_617_478, 65_536),
    slow(1_308_733, 16_384),
    slow(654_366, 4_096),
    slow(327_183, 1_024),
    // The integrator: the integral of the sum above over all slower modes, `(2 / pi) sqrt(2^-26)`.
    slow(333_772, 0),
];
/// Response of all slow modes together to a scaled flux of 1, one tick later: the sum of `g e^-r`.
const SLOW_INPUT_GAIN: I0F32 = I0F32::from_bits(83_730_349);

/// Horizon of [`HalfSpace::scaled_flux_to_match`], ticks.
pub const MATCH_HORIZON_TICKS: u32 = 20;
/// Inverse of the response to a constant scaled flux of 1 after [`MATCH_HORIZON_TICKS`], 1 / 5.060.
const INVERSE_HORIZON_GAIN: I0F32 = I0F32::from_bits(848_800_003);
/// Response to a scaled flux of 1 at the end of its tick: the sum of all `g`, and `2 / pi` for the feed-through.
const TICK_GAIN: I12F20 = I12F20::from_bits(1_240_943);

/// Change of the surface temperature of a half-space, updated tick by tick; the default is uniform.
///
/// Error of the response to a constant flux: 5 % at the first tick, 1.2 % at the second, 0.4 % from 10 to 6e4
/// ticks. After a pulse of 6e4 ticks the error is 0.07 % of the peak
/// (`cargo test -p contact-model half_space`). No input overflows: a scaled flux is limited to ±32 K, more
/// than any contact gives, and the response saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfSpace {
    /// States of the fast modes at the end of the coming tick if no flux flows, K. The limited flux keeps them
    /// within ±320 K.
    fast: [I10F54; FAST],
    /// States of the slow modes at the start of the window, K; limited to ±256 K.
    slow: [I10F54; SLOW],
    /// Sum of the slow modes at the start of the window.
    slow_sum: Celsius,
    /// Change of this sum since, K.
    slow_change: I10F54,
    /// Decay of this sum in a tick, K.
    slow_decay: I10F54,
    /// Sum of the scaled fluxes since the start of the window.
    flux_sum: Celsius,
    /// Length of the window, ticks.
    window: u32,
    /// Ticks until its end.
    ticks_left: u32,
    free_response: Celsius,
}

impl Default for HalfSpace {
    fn default() -> Self {
        Self {
            fast: [I10F54::ZERO; FAST],
            slow: [I10F54::ZERO; SLOW],
            slow_sum: Celsius::ZERO,
            slow_change: I10F54::ZERO,
            slow_decay: I10F54::ZERO,
            flux_sum: Celsius::ZERO,
            window: WINDOW,
            ticks_left: WINDOW,
            free_response: Celsius::ZERO,
        }
    }
}

/// A state, rounded down.
fn celsius(state: I10F54) -> Celsius {
    Celsius::lossy_from(state)
}

/// A state limited to ±256 K, so that the fluxes of a window can be added. The low 32 bits stay as they are.
fn limited(state: I10F54) -> I10F54 {
    const LIMIT: Celsius = Celsius::const_from_int(256);
    let high = celsius(state).clamp(-LIMIT, LIMIT - Celsius::DELTA);
    I10F54::from(high) | (state & I10F54::from_bits(u32::MAX as i64))
}

/// A scaled flux limited to ±32 K.
fn bounded(scaled_flux: Celsius) -> Celsius {
    const BOUND: Celsius = Celsius::const_from_int(32);
    scaled_flux.clamp(-BOUND, BOUND - Celsius::DELTA)
}

impl HalfSpace {
    /// The same state with windows that end half a window apart from this one's. Of two half-spaces that are
    /// updated together, only one then has to update its slow modes in any tick.
    #[must_use]
    pub fn staggered(&self) -> Self {
        let mut other = *self;
        other.end_window((self.ticks_left + WINDOW / 2 - 1) % WINDOW + 1);
        other
    }

    /// Change of the surface temperature at the end of the coming tick if no flux flows, K.
    #[must_use]
    pub const fn free_response(&self) -> Celsius {
        self.free_response
    }

    /// Change of the surface temperature at the end of the coming tick if `scaled_flux` flows in it, K.
    #[must_use]
    pub fn response_to(&self, scaled_flux: Celsius) -> Celsius {
        self.free_response
            .saturating_add(product(bounded(scaled_flux), TICK_GAIN))
    }

    /// Updates the state by one tick in which `scaled_flux` flows.
    pub fn step(&mut self, scaled_flux: Celsius) {
        let flux = bounded(scaled_flux);
        let mut fast_sum = Celsius::ZERO;
        for (state, mode) in self.fast.iter_mut().zip(&FAST_MODES) {
            *state += flux.wide_mul(mode.input_gain);
            *state += celsius(*state).wide_mul(-mode.decay);
            fast_sum = fast_sum.saturating_add(celsius(*state));
        }
        self.flux_sum += flux;
        self.slow_change += flux.wide_mul(SLOW_INPUT_GAIN) - self.slow_decay;
        self.ticks_left -= 1;
        if self.ticks_left == 0 {
            self.end_window(WINDOW);
        }
        self.free_response = fast_sum.saturating_add(self.slow_response());
    }

    /// Sum of the slow modes, extrapolated from the start of the window.
    fn slow_response(&self) -> Celsius {
        self.slow_sum.saturating_add(celsius(self.slow_change))
    }

    /// Updates the slow modes by the ticks that have passed of the window, and starts one of `ticks`.
    fn end_window(&mut self, ticks: u32) {
        let passed = (self.window - self.ticks_left) as i32;
        let (mut sum, mut decay) = (Celsius::ZERO, I10F54::ZERO);
        for (state, mode) in self.slow.iter_mut().zip(&SLOW_MODES) {
            *state += self.flux_sum.wide_mul(mode.input_gain);
            let decayed = celsius(*state).wide_mul(mode.decay / WINDOW as i32 * passed);
            *state = limited(*state - decayed);
            sum = sum.saturating_add(celsius(*state));
            decay += celsius(*state).wide_mul(mode.decay);
        }
        (self.slow_sum, self.slow_change) = (sum, I10F54::ZERO);
        self.slow_decay = decay / i64::from(WINDOW);
        (self.flux_sum, self.window, self.ticks_left) = (Celsius::ZERO, ticks, ticks);
    }

    /// The constant scaled flux that, added to a flux common to both, brings this surface to that of `other`
    /// within [`MATCH_HORIZON_TICKS`], K.
    #[must_use]
    pub fn scaled_flux_to_match(&self, other: &Self) -> Celsius {
        let mut fast = I11F53::ZERO;
        for ((from, to), mode) in self.fast.iter().zip(&other.fast).zip(&FAST_MODES) {
            let difference = celsius(*to).saturating_sub(celsius(*from));
            fast += difference.wide_mul(mode.horizon_factor);
        }
        // The slow modes are extrapolated along their straight lines.
        let slow_decay = (other.slow_decay - self.slow_decay) * i64::from(MATCH_HORIZON_TICKS - 1);
        let slow = other.slow_response().saturating_sub(self.slow_response());
        let half_of_fast = Celsius::from_bits((fast.to_bits() >> 32) as i32);
        let difference = half_of_fast
            .saturating_add(half_of_fast)
            .saturating_add(slow)
            .saturating_sub(celsius(slow_decay));
        product(difference, INVERSE_HORIZON_GAIN)
    }
}

#[cfg(test)]
mod tests;

//! Temperature change of a surface under any heat flux, as a sum of first-order relaxations.
//!
//! A surface impedance `Z(s) = direct + sum of g / (s + l)` answers a heat flux with one first-order state for each
//! pair of gain `g` and rate `l`; a rate of zero is an integrator. What settles within a tick is the direct term.
//!
//! The input is the *scaled flux* of one tick, in K: the heat flux times `sqrt(dt) / e_skin`. The output is the change of
//! the surface temperature since the body was uniform, in K.
//!
//! Fast relaxations are updated every tick. Slow ones are updated once per window of [`WINDOW`] ticks, with the sum of
//! the window's fluxes; within a window their sum is extrapolated along a straight line.

use fixed::traits::LossyFrom;
use fixed::types::{I0F32, I1F31, I5F27, I10F54, I11F53, I12F20};

use super::half_space::inverse;
use super::{Celsius, product};

/// Ticks between two updates of the slow relaxations.
pub(super) const WINDOW: u32 = 8;
/// Horizon of [`RelaxationBank::scaled_flux_to_match`], ticks.
pub const MATCH_HORIZON_TICKS: u32 = 20;

/// Coefficients of a fast relaxation of rate `r` per tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FastRelaxation {
    /// Response to a scaled flux of 1 in one tick.
    pub(super) input_gain: I0F32,
    /// Change of the state in a tick over the state, `e^-r - 1`: negative, for the processor's multiply and add.
    pub(super) change: I0F32,
    /// Fraction of the state that remains at the horizon of [`RelaxationBank::scaled_flux_to_match`], `e^(-19 r)`.
    pub(super) horizon_factor: I1F31,
}

impl FastRelaxation {
    /// One that answers nothing, for unused places.
    pub(super) const ZERO: Self = Self::from_bits([0; 3]);

    /// From the bits of input gain, decay (the negative change) and horizon factor.
    pub(super) const fn from_bits([input_gain, decay, horizon_factor]: [i32; 3]) -> Self {
        Self {
            input_gain: I0F32::from_bits(input_gain),
            change: I0F32::from_bits(-decay),
            horizon_factor: I1F31::from_bits(horizon_factor),
        }
    }
}

/// Coefficients of a slow relaxation of rate `r` per tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlowRelaxation {
    /// Response to the sum of a window's scaled fluxes: that of one tick, times the mean of `e^(r j)` for `j` from 0
    /// to 7, because a flux decays only from its own tick to the end of the window.
    pub(super) input_gain: I0F32,
    /// Fraction of the state that decays in a window, `1 - e^(-8 r)`.
    pub(super) decay: I0F32,
}

impl SlowRelaxation {
    /// One that answers nothing, for unused places.
    pub(super) const ZERO: Self = Self::from_bits([0; 2]);

    /// From the bits of input gain and decay.
    pub(super) const fn from_bits([input_gain, decay]: [i32; 2]) -> Self {
        Self { input_gain: I0F32::from_bits(input_gain), decay: I0F32::from_bits(decay) }
    }
}

/// Coefficients of all relaxations of a body.
#[derive(Clone, Copy, Debug)]
pub struct Relaxations<'a> {
    /// The fast ones, updated every tick.
    pub(super) fast: &'a [FastRelaxation],
    /// The slow ones, updated once per window, and unused places.
    pub(super) slow: &'a [SlowRelaxation],
    /// How many slow ones are used.
    pub(super) slow_count: usize,
    /// Response of all slow relaxations together to a scaled flux of 1, one tick later: the sum of `g e^-r`.
    pub(super) slow_input_gain: I0F32,
    /// Response to a scaled flux of 1 at the end of its tick: the sum of all gains, and the direct term.
    pub(super) tick_gain: I12F20,
    /// Inverse of the response to a constant scaled flux of 1 after [`MATCH_HORIZON_TICKS`].
    pub(super) inverse_horizon_gain: I0F32,
    /// The states are temperatures divided by this power of two, for bodies whose gains exceed the range of theirs.
    pub(super) state_scale: i32,
}

/// Factors by which states change when the gains of their relaxations change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateFactors<const FAST: usize, const SLOW: usize> {
    fast: [I5F27; FAST],
    slow: [I5F27; SLOW],
}

impl<const FAST: usize, const SLOW: usize> StateFactors<FAST, SLOW> {
    /// Factors for a change from the relaxations `from` to `to`, of the same rates in the same order. A relaxation without a
    /// gain above its resolution in `from` keeps its state; a factor is at most 16.
    pub fn new(from: &Relaxations<'_>, to: &Relaxations<'_>) -> Self {
        let mut factors = Self { fast: [I5F27::ONE; FAST], slow: [I5F27::ONE; SLOW] };
        for ((own, from), to) in factors.fast.iter_mut().zip(from.fast).zip(to.fast) {
            *own = ratio(from.input_gain, to.input_gain);
        }
        let slow = factors.slow.iter_mut().zip(from.slow).zip(to.slow);
        for ((own, from), to) in slow.take(to.slow_count) {
            *own = ratio(from.input_gain, to.input_gain);
        }
        factors
    }
}

/// `to / from`, and 1 if `from` is at most its resolution; saturates. Relative error below 2^-27, and one unit. A division of 64
/// bits costs some two hundred cycles.
#[inline(never)]
fn ratio(from: I0F32, to: I0F32) -> I5F27 {
    let (from, to) = (from.to_bits(), i64::from(to.to_bits()));
    if from <= 1 {
        return I5F27::ONE;
    }
    let zeros = from.leading_zeros();
    // 2^62 / (2^zeros from), relative error below 2^-28.
    let inverse = i64::from(inverse((from as u32) << zeros));
    let bits = (to * inverse) >> (62 - I5F27::FRAC_NBITS - zeros);
    I5F27::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
}

/// A state times a factor; saturates. In 32 bits at a time: a product of 128 bits costs 75 cycles.
#[inline(never)]
fn rescaled(state: I10F54, factor: I5F27) -> I10F54 {
    let (bits, factor) = (state.to_bits(), i64::from(factor.to_bits()));
    let low = (i64::from(bits as u32) * factor) >> I5F27::FRAC_NBITS;
    let high = (bits >> 32) * factor;
    // The high part in units of 2^-22 K: at most 2^36.
    const UP: u32 = 32 - I5F27::FRAC_NBITS;
    I10F54::from_bits(high.saturating_mul(1 << UP).saturating_add(low))
}

/// Change of the surface temperature of a body, updated tick by tick; the default is uniform. It has room for `FAST` fast
/// and `SLOW` slow relaxations, of which the coefficients may name fewer.
///
/// No input overflows: a scaled flux is limited to ±32 K, more than any contact gives, and the states saturate.
// In C order, what all banks have stands at the same place in each, so that reading it takes no look at their size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct RelaxationBank<const FAST: usize, const SLOW: usize> {
    free_response: Celsius,
    /// Ticks until the end of the window.
    pub(super) ticks_left: u32,
    /// Length of the window, ticks.
    window: u32,
    /// Sum of the scaled fluxes since the start of the window.
    flux_sum: Celsius,
    /// Change of the sum of the slow relaxations since the start of the window, K.
    slow_change: I10F54,
    /// Decay of this sum in a tick, K.
    slow_decay: I10F54,
    /// Sum of the slow relaxations at the start of the window.
    slow_sum: Celsius,
    /// States of the fast relaxations at the end of the coming tick if no flux flows, K.
    fast: [I10F54; FAST],
    /// States of the slow relaxations at the start of the window, K; limited to ±256 K.
    slow: [I10F54; SLOW],
}

impl<const FAST: usize, const SLOW: usize> Default for RelaxationBank<FAST, SLOW> {
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

/// A sum of states as a temperature; saturates.
fn scaled_up(sum: Celsius, state_scale: i32) -> Celsius {
    Celsius::from_bits(sum.to_bits().saturating_mul(state_scale))
}

/// A scaled flux limited to ±32 K.
fn bounded(scaled_flux: Celsius) -> Celsius {
    const BOUND: Celsius = Celsius::const_from_int(32);
    scaled_flux.clamp(-BOUND, BOUND - Celsius::DELTA)
}

/// Updates the states of slow relaxations by the flux of the ticks that have passed; their sum, and its decay in a window.
/// Not inlined: unrolled, the loop has more values than the processor has registers.
#[inline(never)]
fn updated_slow(
    states: &mut [I10F54],
    relaxations: &[SlowRelaxation],
    flux_sum: Celsius,
    passed: i32,
) -> (Celsius, I10F54) {
    let (mut sum, mut decay) = (Celsius::ZERO, I10F54::ZERO);
    for (state, relaxation) in states.iter_mut().zip(relaxations) {
        let mut updated = *state + flux_sum.wide_mul(relaxation.input_gain);
        let decay_of_tick = relaxation.decay >> WINDOW.ilog2();
        updated += celsius(updated).wide_mul(decay_of_tick * -passed);
        *state = limited(updated);
        sum = sum.saturating_add(celsius(*state));
        decay += celsius(*state).wide_mul(relaxation.decay);
    }
    (sum, decay)
}

impl<const FAST: usize, const SLOW: usize> RelaxationBank<FAST, SLOW> {
    /// The same state with windows that end half a window apart from this one's. Of two bodies that are
    /// updated together, only one then has to update its slow relaxations in any tick.
    #[inline]
    pub fn staggered(&self, relaxations: &Relaxations<'_>) -> Self {
        let mut other = *self;
        other.end_window((self.ticks_left + WINDOW / 2 - 1) % WINDOW + 1, relaxations);
        other
    }

    /// A uniform body whose windows end with those of another one.
    pub fn uniform_in_step_with<const F: usize, const S: usize>(
        other: &RelaxationBank<F, S>,
    ) -> Self {
        Self { window: other.window, ticks_left: other.ticks_left, ..Self::default() }
    }

    /// Change of the surface temperature at the end of the coming tick if no flux flows, K.
    pub const fn free_response(&self) -> Celsius {
        self.free_response
    }

    /// Change of the surface temperature at the end of the coming tick if `scaled_flux` flows in it, K.
    #[inline]
    pub fn response_to(&self, scaled_flux: Celsius, relaxations: &Relaxations<'_>) -> Celsius {
        self.free_response.saturating_add(product(bounded(scaled_flux), relaxations.tick_gain))
    }

    /// Updates the state by one tick in which `scaled_flux` flows.
    #[inline(always)]
    pub fn step(&mut self, scaled_flux: Celsius, relaxations: &Relaxations<'_>) {
        let flux = bounded(scaled_flux);
        let mut fast_sum = Celsius::ZERO;
        for (state, relaxation) in self.fast.iter_mut().zip(relaxations.fast) {
            let FastRelaxation { input_gain, change, .. } = *relaxation;
            let heated = *state + flux.wide_mul(input_gain);
            *state = heated + celsius(heated).wide_mul(change);
            fast_sum = fast_sum.saturating_add(celsius(*state));
        }
        self.flux_sum += flux;
        self.slow_change += flux.wide_mul(relaxations.slow_input_gain) - self.slow_decay;
        self.ticks_left -= 1;
        if self.ticks_left == 0 {
            self.end_window(WINDOW, relaxations);
        }
        let sum = fast_sum.saturating_add(self.slow_response());
        self.free_response = scaled_up(sum, relaxations.state_scale);
    }

    /// Sum of the slow relaxations, extrapolated from the start of the window.
    fn slow_response(&self) -> Celsius {
        self.slow_sum.saturating_add(celsius(self.slow_change))
    }

    /// Updates the slow relaxations by the ticks that have passed of the window, and starts one of `ticks`.
    #[inline]
    fn end_window(&mut self, ticks: u32, relaxations: &Relaxations<'_>) {
        let slow = &relaxations.slow[..relaxations.slow_count.min(SLOW)];
        let passed = self.window - self.ticks_left;
        let (sum, decay) = updated_slow(&mut self.slow, slow, self.flux_sum, passed as i32);
        (self.slow_sum, self.slow_change) = (sum, I10F54::ZERO);
        self.slow_decay = decay / i64::from(WINDOW);
        (self.flux_sum, self.window, self.ticks_left) = (Celsius::ZERO, ticks, ticks);
    }

    /// Makes the state, which the relaxations `from` of [`StateFactors::new`] have made, the one that the relaxations `to`
    /// would have made by the same fluxes; error of each state at most 2^-26 times the state before, per call, and of the
    /// surface the resolution of the states' sum.
    #[inline(never)]
    pub fn rescale(&mut self, factors: &StateFactors<FAST, SLOW>, to: &Relaxations<'_>) {
        let (mut fast_sum, mut slow_sum) = (Celsius::ZERO, Celsius::ZERO);
        for ((state, factor), _) in self.fast.iter_mut().zip(factors.fast).zip(to.fast) {
            *state = rescaled(*state, factor);
            fast_sum = fast_sum.saturating_add(celsius(*state));
        }
        let mut decay = I10F54::ZERO;
        let slow = self.slow.iter_mut().zip(factors.slow);
        for ((state, factor), relaxation) in slow.zip(to.slow).take(to.slow_count) {
            *state = limited(rescaled(*state, factor));
            slow_sum = slow_sum.saturating_add(celsius(*state));
            decay += celsius(*state).wide_mul(relaxation.decay);
        }
        self.slow_sum = slow_sum;
        self.slow_decay = decay / i64::from(WINDOW);
        let passed = i64::from(self.window - self.ticks_left);
        self.slow_change = self.flux_sum.wide_mul(to.slow_input_gain) - self.slow_decay * passed;
        let sum = fast_sum.saturating_add(self.slow_response());
        self.free_response = scaled_up(sum, to.state_scale);
    }

    /// The constant scaled flux that, added to a flux common to both, brings this surface to that of `other`
    /// within [`MATCH_HORIZON_TICKS`], K.
    #[inline]
    pub fn scaled_flux_to_match(&self, other: &Self, relaxations: &Relaxations<'_>) -> Celsius {
        let mut fast = I11F53::ZERO;
        for ((from, to), relaxation) in self.fast.iter().zip(&other.fast).zip(relaxations.fast) {
            let difference = celsius(*to).saturating_sub(celsius(*from));
            fast += difference.wide_mul(relaxation.horizon_factor);
        }
        // The slow relaxations are extrapolated along their straight lines.
        let slow_decay = (other.slow_decay - self.slow_decay) * i64::from(MATCH_HORIZON_TICKS - 1);
        let slow = other.slow_response().saturating_sub(self.slow_response());
        let half_of_fast = Celsius::from_bits((fast.to_bits() >> 32) as i32);
        let difference = half_of_fast
            .saturating_add(half_of_fast)
            .saturating_add(slow)
            .saturating_sub(celsius(slow_decay));
        let difference = scaled_up(difference, relaxations.state_scale);
        product(difference, relaxations.inverse_horizon_gain)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn ratio_is_that_of_a_long_division(from in 2..=i32::MAX, shift in 0..30u32, to in 0..=i32::MAX) {
            let from: i32 = (from >> shift).max(2);
            let exact = ((i128::from(to) << 27) / i128::from(from)).min(i32::MAX.into());
            let found = i128::from(ratio(I0F32::from_bits(from), I0F32::from_bits(to)).to_bits());
            let bound = 1 + (exact >> 27);
            prop_assert!((found - exact).abs() <= bound, "{to} / {from}: {found}, exact {exact}");
        }

        #[test]
        fn rescaled_is_the_long_product(state: i64, factor: i32) {
            let exact = (i128::from(state) * i128::from(factor)) >> 27;
            let exact = exact.clamp(i64::MIN.into(), i64::MAX.into());
            let found = rescaled(I10F54::from_bits(state), I5F27::from_bits(factor)).to_bits();
            // The part of the low 32 bits is added after the high part has been limited.
            let is_near_limit = exact.unsigned_abs() > (i64::MAX as u128) - (1 << 37);
            let bound = if is_near_limit { 1 << 37 } else { 1 };
            prop_assert!((i128::from(found) - exact).abs() <= bound, "{found}, exact {exact}");
        }
    }

    #[test]
    fn a_gain_of_no_more_than_its_resolution_leaves_the_state() {
        for from in [i32::MIN, -1, 0, 1] {
            assert_eq!(ratio(I0F32::from_bits(from), I0F32::MAX), I5F27::ONE, "{from}");
        }
    }
}

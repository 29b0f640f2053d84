//! Set-point of a contact under constant force: `E` is evaluated at knots and interpolated by chords.
//!
//! Under constant force Eq. 6-12 is `base + amplitude E(u)`, with `base = T_skin,i - dT w`,
//! `amplitude = dT (w - r)` and `u = b² t`. `E` is completely monotone, so a chord lies above it. A chord that
//! begins at `u`, at `m` times its own length after landing, lies above by at most `u² E''(u) G(m)`:
//!
//! ```text
//! u² E''(u) <= 0.1495        G(m) = y² / (y + 2) <= 1 / (4 m (2 m + 1))        y = sqrt(1 + 1/m) - 1
//! ```
//!
//! `G` is the bound for a square root; `E` bends less, because `u^1.5 E''` decreases. Knots lie one tolerance
//! beyond `E`, on the side away from the chord, so that a chord may deviate from `E` by two tolerances.
//!
//! Time is counted in lengths of the current chord, from `m` to `2 m`; then the length doubles. Each octave of
//! time so takes `m` evaluations, and the counts stay small however long the contact lasts.

use core::sync::atomic::{Ordering, compiler_fence};

use super::contact::{interface, preset};
use super::{Celsius, Contact, Fraction, MantissaExponent, Ticks, erfcx, product};

/// Error that the kernel and rounding add to that of a chord.
const ROUNDING: Celsius = Celsius::from_bits(6);
/// Temperatures saturate at this magnitude.
const LIMIT_C: Celsius = Celsius::const_from_int(127);
/// Bound of `u² E''(u)`, in units of 1e-4.
const CURVATURE: u64 = 1495;
/// Length of the longest chord, log2 of ticks.
const MAX_LENGTH_LOG2: u32 = 31;
/// Mask that takes the fraction left of a chord from 1 to 0, where the next chord begins.
const FRACTION_MASK: u32 = (1 << MAX_LENGTH_LOG2) - 1;
/// Contact times saturate here, in ticks: 180 000 years of 10 us.
const MAX_ELAPSED: u64 = 1 << 59;

/// Set-point of one contact, tick by tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)] // Fields that are used together are neighbours, to be loaded and stored in pairs.
pub struct ChordInterpolation {
    /// End at which the chords' length doubles, and end of the current chord, in chord lengths since landing.
    doubling: Ticks,
    end: Ticks,
    /// Fraction of the chord that is left, 2^-31; 0 at a knot.
    left: u32,
    /// Decrease of `left` in a tick.
    left_per_tick: u32,
    /// Set-point at the chord's end.
    end_setpoint: Celsius,
    /// Twice the difference of the set-points at the chord's start and end.
    twice_fall: Celsius,
    base: Celsius,
    twice_amplitude: Celsius,
    /// `b² dt` for one chord length in place of `dt`.
    rate_per_length: MantissaExponent,
}

impl ChordInterpolation {
    /// Interpolation from `elapsed` ticks after landing on, with an error of at most `tolerance` (2 µK or more)
    /// from Eq. 6-12. The second value is the number of evaluations of `E` it took, at most 2.
    ///
    /// Set-points beyond ±127 °C saturate. Where an evaluation could not change the set-point by the tolerance, it
    /// is constant and nothing is evaluated: contacts that cannot be distinguished from perfect contact (Eq. 3-1), from no
    /// contact, or whose `dT (w - r)` is nearly 0 (both at the preset).
    pub fn new(
        contact: &Contact,
        skin: Celsius,
        object: Celsius,
        elapsed: u64,
        tolerance: Celsius,
    ) -> (Self, u32) {
        let limited = |t: Celsius| t.clamp(-LIMIT_C, LIMIT_C);
        let base = limited(interface(contact.weight, skin, object));
        let preset = limited(preset(contact.ratio, skin, object));
        let amplitude = preset - base;
        let tolerance = tolerance.saturating_sub(ROUNDING).max(Celsius::DELTA);
        if amplitude.abs() <= tolerance {
            return (Self::constant(preset), 0);
        }
        let (tolerance_bits, size) = (
            u64::from(tolerance.to_bits().unsigned_abs()),
            u64::from(amplitude.to_bits().unsigned_abs()),
        );
        let elapsed = elapsed.min(MAX_ELAPSED);
        // `E` is below 1 / sqrt(pi u): too small to matter late in a contact with little resistance.
        let octave = elapsed.max(1).ilog2() as i32 + contact.rate_per_tick.exponent();
        if octave > 2 * (size.ilog2() as i32 - tolerance_bits.ilog2() as i32) {
            return (Self::constant(base), 0);
        }
        let first = first_octave(tolerance_bits, size) - contact.rate_per_tick.exponent();
        // Over the first chord `E` falls by at most eight tolerances, and by one over its first 64th.
        if first > MAX_ELAPSED.ilog2() as i32 + 6 {
            return (Self::constant(preset), 0);
        }
        let lengths = lengths_per_octave(size, tolerance_bits);
        let later = octaves(elapsed, lengths);
        let length = (first.max(0) as u32).max(later).min(MAX_LENGTH_LOG2);
        let end = (elapsed >> length) + 1;
        let end_erfcx = erfcx_at(end << length, contact.rate_per_tick);
        let (start_erfcx, evaluations) = match elapsed {
            0 => (Fraction::MAX, 1),
            _ => (erfcx_at(elapsed, contact.rate_per_tick), 2),
        };
        let base = if amplitude > 0 { base - tolerance } else { base + tolerance };
        let twice_amplitude = amplitude + amplitude;
        let setpoint = |e: Fraction| plus_part(base, twice_amplitude, e.to_bits() >> 1);
        let (start_setpoint, end_setpoint) = (setpoint(start_erfcx), setpoint(end_erfcx));
        let ticks = (end << length) - elapsed;
        // The fall over a whole length, as if the chord had begun at a multiple of its length.
        let fall = fall_per_length((start_setpoint - end_setpoint).to_bits(), length, ticks);
        let left_per_tick = (1 << MAX_LENGTH_LOG2) >> length;
        let chords = Self {
            left: left_per_tick * ticks as u32,
            left_per_tick,
            end_setpoint,
            twice_fall: Celsius::from_bits((2 * fall) as i32),
            base,
            twice_amplitude,
            rate_per_length: contact.rate_per_tick.times_power_of_2(length as i16),
            end: Ticks::new(end as u32).unwrap_or(Ticks::MAX),
            doubling: Ticks::new(2 * lengths as u32).unwrap_or(Ticks::MAX),
        };
        (chords, evaluations)
    }

    /// Set-point of the current tick.
    pub fn setpoint(&self) -> Celsius {
        let left = match self.left {
            0 => 1 << MAX_LENGTH_LOG2,
            left => left,
        };
        plus_part(self.end_setpoint, self.twice_fall, left)
    }

    /// Whether the last [`Self::advance`] evaluated `E`.
    pub const fn has_just_evaluated(&self) -> bool {
        self.left == 0
    }

    /// Magnitude of the set-point's change over the contact, `|dT (w - r)|`, K.
    pub const fn transient_amplitude(&self) -> Celsius {
        Celsius::from_bits(self.twice_amplitude.to_bits() >> 1).abs()
    }

    /// Set-point of the next tick: 8 instructions, 59 where `E` is evaluated, 67 where the chords' length also doubles.
    #[inline(always)]
    pub fn advance(&mut self) -> Celsius {
        let left = self.left.wrapping_sub(self.left_per_tick) & FRACTION_MASK;
        if left == 0 {
            return self.start_chord();
        }
        self.left = left;
        // No instruction: keeps the compiler from turning the branch into conditional instructions.
        compiler_fence(Ordering::SeqCst);
        plus_part(self.end_setpoint, self.twice_fall, left)
    }

    /// Starts the next chord, twice as long if it is due and possible.
    #[inline(always)]
    fn start_chord(&mut self) -> Celsius {
        let (mut start, mut rate) = (self.end.get(), self.rate_per_length);
        if start == self.doubling.get() {
            // No instruction: keeps the compiler from executing this rare case conditionally.
            compiler_fence(Ordering::SeqCst);
            if self.left_per_tick == 1 {
                // The chords have their greatest length, and keep it.
                self.doubling = Ticks::MAX;
            } else {
                start >>= 1;
                self.left_per_tick >>= 1;
                rate = rate.twice();
                self.rate_per_length = rate;
            }
        }
        (self.end, self.left) = (Ticks::after(start), 0);
        let e = erfcx(self.end, rate).to_bits() >> 1;
        // No instruction: the fields below are loaded after the kernel, which needs the registers.
        compiler_fence(Ordering::SeqCst);
        let start_setpoint = self.end_setpoint;
        self.end_setpoint = plus_part(self.base, self.twice_amplitude, e);
        let fall = start_setpoint.wrapping_sub(self.end_setpoint);
        self.twice_fall = fall.wrapping_add(fall);
        start_setpoint
    }

    /// A set-point that does not change.
    const fn constant(setpoint: Celsius) -> Self {
        Self {
            left: 1,
            left_per_tick: 0,
            end_setpoint: setpoint,
            twice_fall: Celsius::ZERO,
            base: setpoint,
            twice_amplitude: Celsius::ZERO,
            rate_per_length: MantissaExponent::ONE,
            end: Ticks::ONE,
            doubling: Ticks::MAX,
        }
    }
}

/// `start + part twice / 2^32`, rounded down: one instruction. `part` is in units of 2^-31 and `twice` is twice
/// the difference it is a part of.
#[inline]
fn plus_part(start: Celsius, twice: Celsius, part: u32) -> Celsius {
    start.wrapping_add(product(twice, Fraction::from_bits(part)))
}

/// `floor(log2(elapsed / lengths))`, at least 0, for `lengths` above 0 and both up to 2^60. Without division, which
/// costs a hundred cycles in 64 bits.
const fn octaves(elapsed: u64, lengths: u64) -> u32 {
    if elapsed < lengths {
        return 0;
    }
    // Both are above 0.
    let estimate = lengths.leading_zeros().saturating_sub(elapsed.leading_zeros());
    estimate - (lengths << (estimate & 63) > elapsed) as u32
}

/// `fall 2^length / ticks`, rounded towards 0; in a 32-bit division where the numbers fit.
fn fall_per_length(fall: i32, length: u32, ticks: u64) -> i64 {
    let scaled = u64::from(fall.unsigned_abs()) << length;
    let size = match (u32::try_from(scaled), u32::try_from(ticks)) {
        (Ok(scaled), Ok(ticks)) => u64::from(scaled.checked_div(ticks).unwrap_or(0)),
        _ => scaled.checked_div(ticks).unwrap_or(0),
    } as i64;
    if fall < 0 { -size } else { size }
}

/// Smallest `m` for which a chord that begins `m` lengths after landing deviates by at most two tolerances, for a
/// set-point of `amplitude`.
fn lengths_per_octave(amplitude: u64, tolerance: u64) -> u64 {
    // amplitude * CURVATURE / (4 m (2 m + 1)) <= 2 tolerance, times 1e4
    let (curvature, allowed) = (amplitude * CURVATURE, 20_000 * tolerance);
    let too_few = |m: u64| 4 * m * (2 * m + 1) * allowed < curvature;
    // The largest that is too few, bit by bit; it is below the root of this quotient.
    let bits = octaves(curvature, 8 * allowed) / 2;
    let largest = (0..=bits).rev().fold(0, |m, bit| {
        let next = m | 1 << bit;
        if too_few(next) { next } else { m }
    });
    largest + 1
}

/// Length of the first chord, log2 of units of `1 / (b² dt)` rounded to its octave. Such a chord, from landing or a
/// later tick to the same end, deviates from `E` by at most `sqrt(u / pi) / 2`, for `u` at its end.
///
/// `tolerance` is above 0 and below `amplitude`, which is below 2^32.
const fn first_octave(tolerance: u64, amplitude: u64) -> i32 {
    // The square root of 2, in 2^-31, rounded down.
    const ROOT: u64 = 3_037_000_499;
    // u <= 4 pi (2 tolerance / amplitude)² in whole octaves: a length of 2^first has u below 2^(first + 1), and
    // 16 pi is above 2^5. The quotient's octaves are in 2^-32; its square has twice as many, or one more.
    let octaves = octaves(tolerance << 32, amplitude);
    let next = amplitude * ((ROOT >> (31 - octaves)) + 1);
    5 - 65 + 2 * octaves as i32 + (tolerance << 32 >= next) as i32
}

/// `E` at `elapsed` ticks, also beyond the range of [`Ticks`].
#[inline(never)] // It is called twice, and not in every tick.
fn erfcx_at(elapsed: u64, rate_per_tick: MantissaExponent) -> Fraction {
    let excess = (u64::BITS - elapsed.leading_zeros()).saturating_sub(MAX_LENGTH_LOG2);
    Ticks::new((elapsed >> excess) as u32)
        .map_or(Fraction::MAX, |ticks| erfcx(ticks, rate_per_tick.times_power_of_2(excess as i16)))
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    /// Pseudo-random numbers of all sizes up to 2^`bits`.
    fn numbers(bits: u32) -> impl Iterator<Item = u64> {
        let mut state = 1u64;
        std::iter::repeat_with(move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let bits = 1 + (state >> 33) as u32 % bits;
            state >> (64 - bits)
        })
    }

    #[test]
    fn integer_shortcuts_agree_with_division() {
        let mut short = numbers(31);
        for (elapsed, lengths) in numbers(60).zip(numbers(31).map(|n| n + 1)).take(200_000) {
            let quotient = elapsed / lengths;
            assert_eq!(
                octaves(elapsed, lengths),
                quotient.checked_ilog2().unwrap_or(0),
                "{elapsed} / {lengths}"
            );
            let (fall, length) = (short.next().expect("endless") as i32, (elapsed % 32) as u32);
            for fall in [fall, -fall] {
                let exact = (i64::from(fall) << length) / lengths as i64;
                assert_eq!(
                    fall_per_length(fall, length, lengths),
                    exact,
                    "{fall} << {length} / {lengths}"
                );
            }
            let (tolerance, amplitude) = (elapsed % lengths, lengths);
            if tolerance > 0 {
                let part = (tolerance << 32) / amplitude;
                let exact = i32::try_from((part * part).ilog2()).expect("below 64") - 60;
                assert_eq!(first_octave(tolerance, amplitude), exact, "{tolerance} of {amplitude}");
                // The integer part of the root, or one more.
                let needed = (amplitude * CURVATURE).div_ceil(20_000 * tolerance);
                let root = (needed / 8).isqrt().max(1);
                let enough = 4 * root * (2 * root + 1) >= needed;
                let exact = if enough { root } else { root + 1 };
                assert_eq!(
                    lengths_per_octave(amplitude, tolerance),
                    exact,
                    "{tolerance} of {amplitude}"
                );
            }
        }
    }
}

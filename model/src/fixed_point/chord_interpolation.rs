//! The set-point of a lasting contact, evaluated only where a straight line would leave its tolerance.
//!
//! Under constant force Eq. 6-12 is `base + gain E(u)`, with `base = T_skin,i - dT w`, `gain = dT (w - r)` and
//! `u = b² t`. `E` is completely monotone, so a chord lies above it, by at most `u² E''(u) G(m)` if it begins at
//! `u`, `m` of its own lengths after landing:
//!
//! ```text
//! u² E''(u) <= 0.1495        G(m) = y² / (y + 2) <= 1 / (4 m (2 m + 1))        y = sqrt(1 + 1/m) - 1
//! ```
//!
//! `G` is what a chord does to a square root; `u^1.5 E''` falls, so `E` bends less. Knots lie one tolerance
//! beyond `E`, so a chord may rise two tolerances above it.
//!
//! A chord's end is counted in lengths of the chord, from `m` to `2 m`; then the length doubles. So each octave
//! of time takes `m` evaluations, and counts stay small however long the contact lasts.

use core::sync::atomic::{Ordering, compiler_fence};

use super::contact::{interface, preset};
use super::{Celsius, Contact, Fraction, MantissaExponent, Ticks, erfcx};

/// What the kernel and roundings may add to the error of a chord.
const ROUNDING: Celsius = Celsius::from_bits(6);
/// Temperatures along a course saturate at this magnitude.
const LIMIT_C: Celsius = Celsius::const_from_int(127);
/// Bound of `u² E''(u)`, in units of 1e-4.
const BEND: u64 = 1495;
/// The longest chord, as a power of two of ticks.
const LONGEST: u32 = 31;
/// All of a chord but its beginning, where as much is left as at its end.
const LEFT: u32 = (1 << LONGEST) - 1;
/// Contact time in ticks at which a new course stops to count: 180 000 years of 10 us.
const LAST: u64 = 1 << 59;

/// Set-point of one finger's contact, tick by tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)] // Neighbours are loaded and stored in pairs.
pub struct ChordInterpolation {
    /// Where the length of a chord doubles, and where the chord ends, in lengths since landing.
    doubles: Ticks,
    end: Ticks,
    /// What is left of the chord, in 2^-31 of it; 0 at a knot.
    left: u32,
    /// What a tick takes off it.
    per_tick: u32,
    /// Set-point at the chord's end, and twice its fall along the chord.
    to: Celsius,
    twice_fall: Celsius,
    base: Celsius,
    twice_gain: Celsius,
    /// `b² dt` of one length.
    rate: MantissaExponent,
}

impl ChordInterpolation {
    /// The set-point from `elapsed` ticks after landing on, within `tolerance` (2 µK at least) of Eq. 6-12.
    /// Second is how often `E` was evaluated for it, up to two times.
    ///
    /// The preset of Eq. 6-12 must be within ±127 °C; beyond, the course saturates. Nothing is evaluated where the
    /// tolerance does not tell a contact from a perfect one, which is at the temperature of Eq. 3-1 for ever, or from
    /// an absent one or `dT (w - r)` from 0, which leave the preset.
    #[must_use]
    pub fn new(
        contact: &Contact,
        skin: Celsius,
        object: Celsius,
        elapsed: u64,
        tolerance: Celsius,
    ) -> (Self, u32) {
        let within = |t: Celsius| t.clamp(-LIMIT_C, LIMIT_C);
        let base = within(interface(contact.weight, skin, object));
        let preset = within(preset(contact.ratio, skin, object));
        let gain = preset - base;
        let tolerance = tolerance.saturating_sub(ROUNDING).max(Celsius::DELTA);
        if gain.abs() <= tolerance {
            return (Self::held(preset), 0);
        }
        let (bits, size) = (
            u64::from(tolerance.to_bits().unsigned_abs()),
            u64::from(gain.to_bits().unsigned_abs()),
        );
        let elapsed = elapsed.min(LAST);
        // `E` is below 1 / sqrt(pi u): all but perfect contact.
        let octave = elapsed.max(1).ilog2() as i32 + contact.rate_per_tick.exponent();
        if octave > 2 * (size.ilog2() as i32 - bits.ilog2() as i32) {
            return (Self::held(base), 0);
        }
        let first = first_octave(bits, size) - contact.rate_per_tick.exponent();
        // Within two tolerances over the first chord means within eight of the preset: an eighth of it is 2^6 earlier.
        if first > LAST.ilog2() as i32 + 6 {
            return (Self::held(preset), 0);
        }
        let lengths = lengths_per_octave(size, bits);
        let later = octaves(elapsed, lengths);
        let length = (first.max(0) as u32).max(later).min(LONGEST);
        let end = (elapsed >> length) + 1;
        let to = erfcx_at(end << length, contact.rate_per_tick);
        let (from, evaluations) = match elapsed {
            0 => (Fraction::MAX, 1),
            _ => (erfcx_at(elapsed, contact.rate_per_tick), 2),
        };
        let base = if gain > 0 {
            base - tolerance
        } else {
            base + tolerance
        };
        let at = |e: Fraction| along(base, gain + gain, e.to_bits() >> 1);
        let (from, to) = (at(from), at(to));
        let ticks = (end << length) - elapsed;
        // As if the chord had begun at a multiple of its length.
        let fall = per_length((from - to).to_bits(), length, ticks);
        let per_tick = (1 << LONGEST) >> length;
        let course = Self {
            left: per_tick * ticks as u32,
            per_tick,
            to,
            twice_fall: Celsius::from_bits((2 * fall) as i32),
            base,
            twice_gain: gain + gain,
            rate: contact.rate_per_tick.times_power_of_2(length as i16),
            end: Ticks::new(end as u32).unwrap_or(Ticks::MAX),
            doubles: Ticks::new(2 * lengths as u32).unwrap_or(Ticks::MAX),
        };
        (course, evaluations)
    }

    /// Set-point now.
    #[must_use]
    pub fn setpoint(&self) -> Celsius {
        let left = match self.left {
            0 => 1 << LONGEST,
            left => left,
        };
        along(self.to, self.twice_fall, left)
    }

    /// Whether the last [`Self::advance`] evaluated `E`.
    #[must_use]
    pub const fn has_just_evaluated(&self) -> bool {
        self.left == 0
    }

    /// Size of what `E` is multiplied with, `|dT (w - r)|`.
    #[must_use]
    pub const fn transient_amplitude(&self) -> Celsius {
        Celsius::from_bits(self.twice_gain.to_bits() >> 1).abs()
    }

    /// Set-point of the next tick: 8 instructions, 59 where `E` is evaluated, 67 where the chords' length doubles too.
    #[inline(always)]
    pub fn advance(&mut self) -> Celsius {
        let left = self.left.wrapping_sub(self.per_tick) & LEFT;
        if left == 0 {
            return self.turn();
        }
        self.left = left;
        // Costs no instruction: keeps the compiler from making all of this conditional.
        compiler_fence(Ordering::SeqCst);
        along(self.to, self.twice_fall, left)
    }

    /// Ends a chord and lays the next, twice as long if that is due and possible.
    #[inline(always)]
    fn turn(&mut self) -> Celsius {
        let (mut begin, mut rate) = (self.end.get(), self.rate);
        if begin == self.doubles.get() {
            // Costs no instruction: keeps a branch around what is seldom due.
            compiler_fence(Ordering::SeqCst);
            if self.per_tick == 1 {
                // The longest chord: from here on, as many of them as there is time.
                self.doubles = Ticks::MAX;
            } else {
                begin >>= 1;
                self.per_tick >>= 1;
                rate = rate.twice();
                self.rate = rate;
            }
        }
        (self.end, self.left) = (Ticks::after(begin), 0);
        let e = erfcx(self.end, rate).to_bits() >> 1;
        // Costs no instruction: what follows is loaded only now, so the kernel has the registers to itself.
        compiler_fence(Ordering::SeqCst);
        let from = self.to;
        self.to = along(self.base, self.twice_gain, e);
        let fall = from.wrapping_sub(self.to);
        self.twice_fall = fall.wrapping_add(fall);
        from
    }

    /// No chord, for ever.
    const fn held(at: Celsius) -> Self {
        Self {
            left: 1,
            per_tick: 0,
            to: at,
            twice_fall: Celsius::ZERO,
            base: at,
            twice_gain: Celsius::ZERO,
            rate: MantissaExponent::ONE,
            end: Ticks::ONE,
            doubles: Ticks::MAX,
        }
    }
}

/// `end` and a part of `twice`, in 2^-32: one instruction, rounded down.
#[inline]
const fn along(end: Celsius, twice: Celsius, part: u32) -> Celsius {
    let above = (twice.to_bits() as i64 * part as i64) >> 32;
    Celsius::from_bits(end.to_bits().wrapping_add(above as i32))
}

/// `floor(log2(elapsed / lengths))`, not below 0, for `lengths` above 0 and both up to 2^60: a long division costs a
/// hundred cycles.
const fn octaves(elapsed: u64, lengths: u64) -> u32 {
    if elapsed < lengths {
        return 0;
    }
    // Both are above 0.
    let least = lengths
        .leading_zeros()
        .saturating_sub(elapsed.leading_zeros());
    least - (lengths << (least & 63) > elapsed) as u32
}

/// `fall` over `ticks`, for a length of `2^length` ticks: rounded towards 0, in a short division where that holds it.
fn per_length(fall: i32, length: u32, ticks: u64) -> i64 {
    let scaled = u64::from(fall.unsigned_abs()) << length;
    let size = match (u32::try_from(scaled), u32::try_from(ticks)) {
        (Ok(scaled), Ok(ticks)) => u64::from(scaled.checked_div(ticks).unwrap_or(0)),
        _ => scaled.checked_div(ticks).unwrap_or(0),
    } as i64;
    if fall < 0 { -size } else { size }
}

/// Smallest `m` for which a chord that begins `m` lengths after landing rises no more than two `tolerance` above a
/// set-point of `gain`.
fn lengths_per_octave(gain: u64, tolerance: u64) -> u64 {
    // gain * BEND / (4 m (2 m + 1)) <= 2 tolerance, times 1e4
    let (bend, allowed) = (gain * BEND, 20_000 * tolerance);
    let too_few = |m: u64| 4 * m * (2 * m + 1) * allowed < bend;
    // The largest that is too few, bit by bit; it is below the root of this quotient.
    let bits = octaves(bend, 8 * allowed) / 2;
    let most = (0..=bits).rev().fold(0, |m, bit| {
        let more = m | 1 << bit;
        if too_few(more) { more } else { m }
    });
    most + 1
}

/// Length of a chord from landing on, or from a later tick to the same end, as a power of two in units of `1 / K`: it
/// rises at most `sqrt(u / pi) / 2` above `E`, for `u` at its end. For a `tolerance` above 0 and below the `gain`, and
/// that below 2^32.
const fn first_octave(tolerance: u64, gain: u64) -> i32 {
    // The square root of 2, in 2^-31, rounded down.
    const ROOT: u64 = 3_037_000_499;
    // u <= 4 pi (2 tolerance / gain)² in whole octaves: a length of 2^first has u below 2^(first + 1), 16 pi is above
    // 2^5. The quotient's octaves, in 2^-32; those of its square are twice as many, or one more.
    let octaves = octaves(tolerance << 32, gain);
    let next = gain * ((ROOT >> (31 - octaves)) + 1);
    5 - 65 + 2 * octaves as i32 + (tolerance << 32 >= next) as i32
}

/// `E` at `elapsed` ticks, which may be more than [`Ticks`] holds.
#[inline(never)] // Called twice where time does not count.
fn erfcx_at(elapsed: u64, rate_per_tick: MantissaExponent) -> Fraction {
    let excess = (u64::BITS - elapsed.leading_zeros()).saturating_sub(LONGEST);
    Ticks::new((elapsed >> excess) as u32).map_or(Fraction::MAX, |ticks| {
        erfcx(ticks, rate_per_tick.times_power_of_2(excess as i16))
    })
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
    fn short_ways_are_those_of_division() {
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
                    per_length(fall, length, lengths),
                    exact,
                    "{fall} << {length} / {lengths}"
                );
            }
            let (tolerance, gain) = (elapsed % lengths, lengths);
            if tolerance > 0 {
                let part = (tolerance << 32) / gain;
                let exact = i32::try_from((part * part).ilog2()).expect("below 64") - 60;
                assert_eq!(
                    first_octave(tolerance, gain),
                    exact,
                    "{tolerance} of {gain}"
                );
                // The whole root below, or the next.
                let needed = (gain * BEND).div_ceil(20_000 * tolerance);
                let root = (needed / 8).isqrt().max(1);
                let enough = 4 * root * (2 * root + 1) >= needed;
                let exact = if enough { root } else { root + 1 };
                assert_eq!(
                    lengths_per_octave(gain, tolerance),
                    exact,
                    "{tolerance} of {gain}"
                );
            }
        }
    }
}

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
use super::{Celsius, Contact, Fraction, Rate, Ticks, erfcx};

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
pub struct Course {
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
    rate: Rate,
}

impl Course {
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
        let octave = elapsed.max(1).ilog2() as i32 + contact.per_tick.exponent();
        if octave > 2 * (size.ilog2() as i32 - bits.ilog2() as i32) {
            return (Self::held(base), 0);
        }
        let first = first_octave((bits << 32) / size) - contact.per_tick.exponent();
        // Within two tolerances over the first chord means within eight of the preset: an eighth of it is 2^6 earlier.
        if first > LAST.ilog2() as i32 + 6 {
            return (Self::held(preset), 0);
        }
        let lengths = lengths_per_octave(size, bits);
        let later = (elapsed / lengths).checked_ilog2().unwrap_or(0);
        let length = (first.max(0) as u32).max(later).min(LONGEST);
        let end = (elapsed >> length) + 1;
        let to = erfcx_at(end << length, contact.per_tick);
        let (from, evaluations) = match elapsed {
            0 => (Fraction::MAX, 1),
            _ => (erfcx_at(elapsed, contact.per_tick), 2),
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
        let fall = (i64::from((from - to).to_bits()) << length) / ticks as i64;
        let per_tick = (1 << LONGEST) >> length;
        let course = Self {
            left: per_tick * ticks as u32,
            per_tick,
            to,
            twice_fall: Celsius::from_bits((2 * fall) as i32),
            base,
            twice_gain: gain + gain,
            rate: contact.per_tick.doubled(length as i16),
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
    pub const fn is_at_knot(&self) -> bool {
        self.left == 0
    }

    /// Size of what `E` is multiplied with, `|dT (w - r)|`.
    #[must_use]
    pub const fn gain(&self) -> Celsius {
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
            rate: Rate::ONE,
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

/// Smallest `m` for which a chord that begins `m` lengths after landing rises no more than two `tolerance` above a
/// set-point of `gain`.
fn lengths_per_octave(gain: u64, tolerance: u64) -> u64 {
    // gain * BEND / (4 m (2 m + 1)) <= 2 tolerance
    let needed = (gain * BEND).div_ceil(20_000 * tolerance);
    let m = (needed / 8).isqrt().max(1);
    if 4 * m * (2 * m + 1) >= needed { m } else { m + 1 }
}

/// Length of a chord from landing on, or from a later tick to the same end, as a power of two in units of `1 / K`: it
/// rises at most `sqrt(u / pi) / 2` above `E`, for `u` at its end. `tolerance` is in 2^-32 of the gain.
fn first_octave(tolerance: u64) -> i32 {
    // u <= 4 pi (2 tolerance)² in whole octaves: a length of 2^first has u below 2^(first + 1), 16 pi is above 2^5.
    5 - 1 - (tolerance * tolerance).leading_zeros() as i32 - 1
}

/// `E` at `elapsed` ticks, which may be more than [`Ticks`] holds.
#[inline(never)] // Called twice where time does not count.
fn erfcx_at(elapsed: u64, per_tick: Rate) -> Fraction {
    let excess = (u64::BITS - elapsed.leading_zeros()).saturating_sub(LONGEST);
    Ticks::new((elapsed >> excess) as u32).map_or(Fraction::MAX, |ticks| {
        erfcx(ticks, per_tick.doubled(excess as i16))
    })
}

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

use super::contact::{interface, part, preset};
use super::{Celsius, Contact, Fraction, Rate, Ticks, erfcx};

/// What the kernel and roundings may add to the error of a chord.
const ROUNDING: Celsius = Celsius::from_bits(6);
/// Temperatures along a course saturate at this magnitude.
const LIMIT_C: Celsius = Celsius::const_from_int(127);
/// Bound of `u² E''(u)`, in units of 1e-4.
const BEND: u64 = 1495;
/// The longest chord, as a power of two of ticks.
const LONGEST: u32 = 31;
/// Its step: what a tick takes off it.
const SHORTEST_STEP: u32 = 1 << (32 - LONGEST);
/// Contact time in ticks at which a new course stops to count: 180 000 years of 10 us.
const LAST: u64 = 1 << 59;

/// Set-point of one finger's contact, tick by tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)] // Neighbours are loaded and stored in pairs.
pub struct Course {
    /// Where the length of a chord doubles, and where the chord ends, in lengths since landing.
    doubles: Ticks,
    end: Ticks,
    /// What is left of the chord, in 2^-32; 0 at a knot.
    left: u32,
    /// What a tick takes off it; 0 is 2^32, the whole of a chord of one tick.
    per_tick: u32,
    /// `E` at the chord's end, and its fall along the chord, in 2^-31.
    to: u32,
    fall: u32,
    base: Celsius,
    twice_gain: Celsius,
    /// `b² dt` of one length.
    rate: Rate,
}

impl Course {
    /// The set-point from `elapsed` ticks after landing on, within `tolerance` (2 µK at least) of Eq. 6-12.
    /// Second is how often `E` was evaluated for it, up to two times.
    ///
    /// The preset of Eq. 6-12 must be within ±127 °C; beyond, the course saturates. Where the tolerance does not
    /// tell a contact from a perfect one (or `dT (w - r)` from 0), it is at the temperature of Eq. 3-1 (the preset)
    /// for ever.
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
        let lengths = lengths_per_octave(size, bits);
        let length = first_length((bits << 32) / size, contact.per_tick)
            .max((elapsed / lengths).checked_ilog2().unwrap_or(0).min(LONGEST));
        let end = (elapsed >> length) + 1;
        let to = erfcx_at(end << length, contact.per_tick);
        if length == 0 && part(gain.abs(), to) <= tolerance {
            return (Self::held(base), 1);
        }
        let (from, evaluations) = match elapsed {
            0 => (Fraction::MAX, 1),
            _ => (erfcx_at(elapsed, contact.per_tick), 2),
        };
        let ticks = (end << length) - elapsed;
        // As if the chord had begun at a multiple of its length.
        let fall = (u64::from(from.to_bits().saturating_sub(to.to_bits())) << length) / ticks;
        let per_tick = ((1u64 << 32) >> length) as u32;
        let course = Self {
            left: per_tick.wrapping_mul(ticks as u32),
            per_tick,
            to: to.to_bits() >> 1,
            fall: (fall >> 1) as u32,
            base: if gain > 0 {
                base - tolerance
            } else {
                base + tolerance
            },
            twice_gain: gain + gain,
            rate: contact.per_tick.doubled(length as i16),
            end: Ticks::new(end as u32).unwrap_or(Ticks::MAX),
            doubles: Ticks::new(2 * lengths as u32).unwrap_or(Ticks::MAX),
        };
        (course, evaluations)
    }

    /// Follows a contact of slightly different resistance from the next knot on, without a step.
    pub fn follow(&mut self, contact: &Contact) {
        let length = self.per_tick.checked_ilog2().map_or(0, |log2| u32::BITS - log2);
        self.rate = contact.per_tick.doubled(length as i16);
    }

    /// Set-point now.
    #[must_use]
    pub fn setpoint(&self) -> Celsius {
        self.at(match self.left {
            0 => self.to + self.fall,
            left => self.along(left),
        })
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

    /// Set-point of the next tick.
    #[inline]
    pub fn advance(&mut self) -> Celsius {
        let left = self.left.wrapping_sub(self.per_tick);
        if left == 0 {
            return self.turn();
        }
        self.left = left;
        self.at(self.along(left))
    }

    /// Ends a chord and lays the next, twice as long if that is due and possible.
    #[cold]
    #[inline(never)]
    fn turn(&mut self) -> Celsius {
        let (mut begin, mut rate) = (self.end.get(), self.rate);
        if begin == self.doubles.get() && self.per_tick != SHORTEST_STEP {
            begin >>= 1;
            self.per_tick = match self.per_tick {
                0 => 1 << 31,
                per_tick => per_tick >> 1,
            };
            rate = rate.twice();
            self.rate = rate;
        }
        (self.end, self.left) = (Ticks::after(begin), 0);
        let e = erfcx(self.end, rate).to_bits() >> 1;
        // Costs no instruction: what follows is loaded only now, so the kernel has the registers to itself.
        compiler_fence(Ordering::SeqCst);
        let from = self.to;
        // Never up: where `E` is all but level, the kernel's error could make it rise.
        self.fall = (from as i32).wrapping_sub(e as i32).max(0) as u32;
        self.to = from.wrapping_sub(self.fall);
        self.at(from)
    }

    /// No chord, for ever.
    const fn held(at: Celsius) -> Self {
        Self {
            left: 1,
            per_tick: 0,
            to: 0,
            fall: 0,
            base: at,
            twice_gain: Celsius::ZERO,
            rate: Rate::ONE,
            end: Ticks::ONE,
            doubles: Ticks::MAX,
        }
    }

    /// `E` on the chord.
    #[inline]
    fn along(&self, left: u32) -> u32 {
        self.to + ((u64::from(self.fall) * u64::from(left)) >> 32) as u32
    }

    /// Set-point where `E` is `e` in 2^-31.
    #[inline]
    fn at(&self, e: u32) -> Celsius {
        let above = (i64::from(self.twice_gain.to_bits()) * i64::from(e as i32)) >> 32;
        Celsius::from_bits(self.base.to_bits().wrapping_add(above as i32))
    }
}

/// Smallest `m` for which a chord that begins `m` lengths after landing rises no more than two `tolerance` above a
/// set-point of `gain`.
fn lengths_per_octave(gain: u64, tolerance: u64) -> u64 {
    // gain * BEND / (4 m (2 m + 1)) <= 2 tolerance
    let needed = (gain * BEND).div_ceil(20_000 * tolerance);
    let m = (needed / 8).isqrt().max(1);
    if 4 * m * (2 * m + 1) >= needed { m } else { m + 1 }
}

/// Length of a chord from landing on, or from a later tick to the same end, as a power of two of ticks: it rises
/// at most `sqrt(u / pi) / 2` above `E`, for `u` at its end. `tolerance` is in 2^-32 of the gain.
fn first_length(tolerance: u64, per_tick: Rate) -> u32 {
    // u <= 4 pi (2 tolerance)² in whole octaves: u is below 2^(length + exponent + 1), 16 pi above 2^5.
    let octave = 5 - 1 - (tolerance * tolerance).leading_zeros() as i32;
    (octave - (per_tick.exponent() + 1)).clamp(0, LONGEST as i32) as u32
}

/// `E` at `elapsed` ticks, which may be more than [`Ticks`] holds.
fn erfcx_at(elapsed: u64, per_tick: Rate) -> Fraction {
    let excess = (u64::BITS - elapsed.leading_zeros()).saturating_sub(LONGEST);
    Ticks::new((elapsed >> excess) as u32).map_or(Fraction::MAX, |ticks| {
        erfcx(ticks, per_tick.doubled(excess as i16))
    })
}

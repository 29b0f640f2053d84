//! The set-point of a lasting contact, evaluated only where a straight line would leave its tolerance.
//!
//! Under constant force Eq. 6-12 is `base + gain E(u)`, with `base = T_skin,i - dT w`, `gain = dT (w - r)` and
//! `u = t b²`. `E` is completely monotone, so a chord lies above it, by at most `B(u) G(m)` if it begins at `u`,
//! `m` of its own lengths after landing:
//!
//! ```text
//! B(u) = u² E''(u) <= 0.43 E (1 - E) (2 - E)
//! G(m) <= 1 / (4 m (2 m + 1))
//! ```
//!
//! `G` is what a chord does to a square root: `u^1.5 E''` falls. All knots but the first lie one tolerance beyond
//! `E`, so a chord may rise two tolerances above. Lengths are powers of two of ticks, and double where the bound
//! allows it. Time is counted in lengths, so that count stays small however long the contact lasts.

use super::contact::{part, scaled};
use super::{Celsius, Contact, Fraction, Rate, Ticks, erfcx};

/// What the kernel and three roundings may add to the error of a chord.
const ROUNDING: Celsius = Celsius::from_bits(8);
/// Temperatures along a course saturate at this magnitude.
const LIMIT_C: Celsius = Celsius::const_from_int(127);
/// `4 / 0.43` with 28 fraction bits, rounded down.
const FOUR_OVER_BOUND: u64 = 2_497_074_009;
/// Largest `allowed`: what a course of hardly any rise needs.
const MOST_ALLOWED: u64 = 1 << 27;
/// The longest chord, as a power of two of ticks.
const LONGEST: u32 = 31;
/// Contact time in ticks at which it stops: 700 000 years of 10 us.
const LAST: u64 = 1 << 61;

/// Set-point of one finger's contact, tick by tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Course {
    /// What is left of the chord, as a negative part of 2^31, and what a tick adds to it.
    left: i32,
    per_tick: u32,
    /// Set-point at the chord's end, and twice the rise to it.
    to: Celsius,
    twice_rise: Celsius,
    /// `b² dt` of one length, and the chord's end in lengths since landing.
    rate: Rate,
    end: u32,
    /// `per_tick` of the next chord.
    next_per_tick: u32,
    base: Celsius,
    twice_gain: Celsius,
    /// Largest bound, over `m (m + 1)`, for which a chord may be twice as long; 28 fraction bits.
    allowed: u32,
}

impl Course {
    /// Where the set-point is `elapsed` ticks after landing, and its way from there: within `tolerance` (3 µK
    /// at least) of Eq. 6-12. Second is how often `E` was evaluated for this, up to two times.
    ///
    /// The preset of Eq. 6-12 must be within ±127 °C; beyond, the course saturates. Contact that is perfect
    /// for the tolerance is at the temperature of Eq. 3-1 from landing on.
    #[must_use]
    pub fn new(
        contact: &Contact,
        skin: Celsius,
        object: Celsius,
        elapsed: u64,
        tolerance: Celsius,
    ) -> (Self, u32) {
        let step = skin.saturating_sub(object);
        let within = |t: Celsius| t.clamp(-LIMIT_C, LIMIT_C);
        let base = within(skin.saturating_sub(part(step, contact.weight)));
        let preset = within(skin.saturating_sub(scaled(step, contact.ratio)));
        let gain = preset - base;
        let tolerance = tolerance.saturating_sub(ROUNDING).max(Celsius::DELTA);
        if gain.abs() <= tolerance {
            return (Self::held(preset), 0);
        }
        let (bits, size) = (
            u64::from(tolerance.to_bits() as u32),
            u64::from(gain.to_bits().unsigned_abs()),
        );
        let mut course = Self {
            base: if gain > 0 {
                base - tolerance
            } else {
                base + tolerance
            },
            twice_gain: gain + gain,
            allowed: (bits * FOUR_OVER_BOUND / size).min(MOST_ALLOWED) as u32,
            ..Self::held(preset)
        };
        let elapsed = elapsed.min(LAST);
        let from_landing = first_length((bits << 32) / size, contact.per_tick);
        let mut evaluations = 0;
        let length = if elapsed == 0 {
            from_landing
        } else {
            let e = erfcx_at(elapsed, contact.per_tick);
            evaluations += 1;
            course.to = course.at(e);
            course.length_at(elapsed, e).max(from_landing)
        };
        let e = erfcx_at(((elapsed >> length) + 1) << length, contact.per_tick);
        if length == 0 && part(gain.abs(), e) <= tolerance {
            return (Self::held(base), evaluations + 1);
        }
        course.begin(contact.per_tick, elapsed, length, e);
        (course, evaluations + 1)
    }

    /// Follows a contact of slightly different resistance from the next knot on, without a step.
    pub fn follow(&mut self, contact: &Contact) {
        self.rate = contact
            .per_tick
            .doubled(self.next_per_tick.leading_zeros() as i16);
    }

    /// Set-point now.
    #[must_use]
    pub fn setpoint(&self) -> Celsius {
        add_part(self.to, self.twice_rise, self.left)
    }

    /// Whether the last [`Self::next`] evaluated `E`.
    #[must_use]
    pub const fn has_turned(&self) -> bool {
        self.left == i32::MIN
    }

    /// Size of what `E` is multiplied with, `|dT (w - r)|`.
    #[must_use]
    pub const fn gain(&self) -> Celsius {
        Celsius::from_bits(self.twice_gain.to_bits() >> 1).abs()
    }

    /// The next tick's set-point.
    #[inline]
    pub fn advance(&mut self) -> Celsius {
        let left = self.left.wrapping_add(self.per_tick as i32);
        if left >= 0 {
            return self.turn();
        }
        self.left = left;
        add_part(self.to, self.twice_rise, left)
    }

    /// Ends a chord, lays the next, and settles the length of the one after it.
    #[cold]
    #[inline(never)]
    fn turn(&mut self) -> Celsius {
        let start = self.to;
        let m = self.end + 1;
        self.end = m;
        let e = Ticks::new(m).map_or(Fraction::ZERO, |end| erfcx(end, self.rate));
        self.to = self.at(e);
        self.twice_rise = Celsius::from_bits(self.to.to_bits().wrapping_sub(start.to_bits()) << 1);
        self.left = i32::MIN;
        self.per_tick = self.next_per_tick;
        if (m | self.next_per_tick) & 1 == 0
            && m.wrapping_mul(m.wrapping_add(1)).wrapping_mul(self.allowed) > bound(e)
        {
            self.end = m >> 1;
            self.next_per_tick >>= 1;
            self.rate = self.rate.doubled(1);
        }
        start
    }

    /// No chord, for ever.
    const fn held(at: Celsius) -> Self {
        Self {
            left: -1,
            per_tick: 0,
            to: at,
            twice_rise: Celsius::ZERO,
            rate: Rate::ONE,
            end: 0,
            next_per_tick: 0,
            base: at,
            twice_gain: Celsius::ZERO,
            allowed: 0,
        }
    }

    /// Lays the first chord, from `to` at `elapsed` to `e` at the next multiple of its length.
    fn begin(&mut self, per_tick: Rate, elapsed: u64, length: u32, e: Fraction) {
        let end = (elapsed >> length) + 1;
        let ticks = (end << length) - elapsed;
        let start = self.to;
        self.to = self.at(e);
        // The chord as if it had begun at a multiple of its length.
        let rise = i64::from(self.to.to_bits() - start.to_bits());
        let twice_rise = (rise << (length + 1)) / ticks as i64;
        self.twice_rise = Celsius::from_bits(twice_rise.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
        self.rate = per_tick.doubled(length as i16);
        self.end = end as u32;
        self.per_tick = (1 << LONGEST) >> length;
        self.next_per_tick = self.per_tick;
        self.left = (self.per_tick.wrapping_mul(ticks as u32) as i32).wrapping_neg();
    }

    /// Length of a chord that begins at `elapsed`, where `E` is `e`, as a power of two of ticks.
    fn length_at(&self, elapsed: u64, e: Fraction) -> u32 {
        let bound = u64::from(bound(e));
        let mut length = elapsed.ilog2().min(LONGEST);
        while length > 0 {
            let m = (elapsed >> length) << 1;
            if m.saturating_mul(m + 1).saturating_mul(self.allowed.into()) > bound {
                break;
            }
            length -= 1;
        }
        length
    }

    #[inline]
    fn at(&self, e: Fraction) -> Celsius {
        add_part(self.base, self.twice_gain, (e.to_bits() >> 1) as i32)
    }
}

/// Length of a chord from landing on, or from a later tick to the same end, as a power of two of ticks: it rises
/// `sqrt(u / pi) / 2` above a square root, for `u` at its end. `tolerance` is in 2^-32 of the gain.
fn first_length(tolerance: u64, per_tick: Rate) -> u32 {
    // u <= 4 pi tolerance², in whole octaves: u is below 2^(length + exponent + 1), 4 pi above 2^3.
    let octave = -1 - (tolerance * tolerance).leading_zeros() as i32;
    (octave + 3 - (i32::from(per_tick.exponent()) + 1)).clamp(0, LONGEST as i32) as u32
}

/// `E` at `elapsed` ticks, which may be more than [`Ticks`] holds.
fn erfcx_at(elapsed: u64, per_tick: Rate) -> Fraction {
    let shift = (33 - elapsed.leading_zeros().min(33)) as i16;
    Ticks::new((elapsed >> shift) as u32).map_or(Fraction::MAX, |ticks| erfcx(ticks, per_tick.doubled(shift)))
}

/// `E (1 - E) (2 - E)` with 28 fraction bits.
#[inline]
fn bound(e: Fraction) -> u32 {
    let (e, rest) = (u64::from(e.to_bits()), u64::from(!e.to_bits()));
    let p = (e * rest) >> 32;
    ((p + ((p * rest) >> 32)) >> 4) as u32
}

/// `from` plus half of `twice` times `part / 2^31`.
#[inline]
fn add_part(from: Celsius, twice: Celsius, part: i32) -> Celsius {
    let change = (i64::from(twice.to_bits()) * i64::from(part)) >> 32;
    Celsius::from_bits(from.to_bits().wrapping_add(change as i32))
}

//! The surface of a half-space under any flux: its heat content, not only its history under a constant force.
//!
//! A flux `q` into a half-space of effusivity `e` moves its surface by the half-order integral of `q / e`: the bodies
//! of Eq. 6-5 and 6-6 under whatever contact. Here `1 / sqrt(s)` is a sum of relaxations a factor of four apart,
//!
//! ```text
//! 1 / sqrt(s) = (1 / pi) integral of e^(v/2) / (s + e^v) dv,  summed at steps of ln 4
//! ```
//!
//! with an integrator for what is slower than all of them and a direct part for what is faster than a tick.
//!
//! The fast relaxations are stepped in every tick. The slow ones are stepped once in a *window* of [`WINDOW`] ticks,
//! with the sum of its drives; within it their sum follows a straight line, and is then summed afresh.
//!
//! Two half-spaces that touch share their flux, and so one sum serves both: their surfaces move in the ratio of
//! their effusivities, in opposite directions.

mod conductance;

pub use conductance::ContactConductance;

use super::Celsius;

/// Relaxations `k`, with rates `r` of `2^-(2 k + 1)` a tick, that are fast: `k` from 0.
const FAST: usize = 5;
/// Slow ones after them, and the integrator.
const SLOW: usize = 9;
/// Ticks in which a slow relaxation is stepped once.
const WINDOW: u32 = 8;

/// A fast relaxation, in one tick.
struct Fast {
    /// Part of a drive that it takes up, `g = (ln 4 / pi) (1 - e^-r) / sqrt(r)`, in 2^-32.
    given: i32,
    /// Part of itself that it loses, `1 - e^-r`, in 2^-32.
    lost: i32,
    /// Part of itself that it still has when [`HalfSpace::drive_to`] looks, `e^(-19 r)`, in 2^-31.
    kept_ahead: i32,
}

/// A slow relaxation, in one window.
struct Slow {
    /// Part of each of its drives that it takes up, in 2^-32: `g` times the mean of `e^(r j)`, `j` from 0 to 7,
    /// because a drive loses only for what is left of the window.
    given: i32,
    /// Part of itself that it loses, `1 - e^(-8 r)`, in 2^-32.
    lost: i32,
}

const fn fast(given: i32, lost: i32, kept_ahead: i32) -> Fast {
    Fast {
        given,
        lost,
        kept_ahead,
    }
}

const FAST_PARTS: [Fast; FAST] = [
    fast(1_054_608_677, 1_689_937_949, 160_743),
    fast(629_882_806, 504_671_961, 199_747_095),
    fast(329_854_396, 132_142_252, 1_185_953_106),
    fast(166_864_942, 33_423_701, 1_851_246_619),
    fast(83_677_061, 8_380_421, 2_069_252_406),
];

const fn slow(given: i32, lost: i32) -> Slow {
    Slow { given, lost }
}

const SLOW_PARTS: [Slow; SLOW] = [
    slow(41_940_820, 16_744_491),
    slow(20_947_371, 4_192_257),
    slow(10_470_809, 1_048_448),
    slow(5_235_045, 262_136),
    slow(2_617_478, 65_536),
    slow(1_308_733, 16_384),
    slow(654_366, 4_096),
    slow(327_183, 1_024),
    // The integrator: the integral of the sum above over all that is slower, `(2 / pi) sqrt(2^-26)`.
    slow(333_772, 0),
];
/// What all slow parts have of a tick's drive when the next begins, the sum of `g e^-r`, in 2^-32.
const SLOW_GIVEN: i32 = 83_730_349;

/// How far ahead [`HalfSpace::drive_to`] looks.
pub const MATCH_HORIZON_TICKS: u32 = 20;
/// The inverse of what a lasting drive of one kelvin moves the surface by in [`MATCH_HORIZON_TICKS`], 1 / 5.060, in 2^-32.
const PER_GAIN_AHEAD: i32 = 848_800_003;
/// What a drive of one kelvin moves the surface by in one tick, in 2^-20: the sum of all `g`, and `2 / pi` for what is
/// faster than a tick.
const GAIN: u32 = 1_240_943;
/// Its binary places.
const GAIN_BITS: u32 = 20;
/// Binary places of a part below those of [`Celsius`].
const BELOW: u32 = 32;

/// How far the surface of a half-space has moved, tick by tick.
///
/// Its input is the *drive* `q sqrt(dt) / e`, in K. Under a constant drive the surface moves within 5 % of the
/// half-space in the first tick, 1.2 % in the second, 0.4 % from 10 to 6e4 ticks; what it leaves after 6e4 ticks is
/// within 0.6 % of what was (`cargo test -p contact-model half_space`). No input makes it overflow: a drive beyond
/// ±32 K, more than any contact gives, counts as that, and the surface saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfSpace {
    /// What each has at the end of the coming tick if nothing flows, K, 54 binary places. As the drive is bounded,
    /// none leaves ±320 K.
    fast: [i64; FAST],
    /// What each had when the window began, likewise. They saturate at ±256 K.
    slow: [i64; SLOW],
    /// Their sum.
    slow_sum: Celsius,
    /// What it has changed by since, and what it loses in a tick, K, 54 binary places.
    since: i64,
    loss: i64,
    /// Sum of the window's drives, in those of [`Celsius`].
    drives: i32,
    /// Ticks of the window, and those of them that are to come.
    window: u32,
    to_come: u32,
    left: Celsius,
}

impl Default for HalfSpace {
    fn default() -> Self {
        Self {
            fast: [0; FAST],
            slow: [0; SLOW],
            slow_sum: Celsius::ZERO,
            since: 0,
            loss: 0,
            drives: 0,
            window: WINDOW,
            to_come: WINDOW,
            left: Celsius::ZERO,
        }
    }
}

/// `a b`: one instruction with the sum that it goes into.
const fn product(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

/// A part, in the binary places of [`Celsius`].
const fn high(part: i64) -> i32 {
    (part >> BELOW) as i32
}

/// A part within ±256 K, to which a window's drives can be added.
fn limited(part: i64) -> i64 {
    const LIMIT: i32 = Celsius::const_from_int(256).to_bits();
    let size = high(part).clamp(-LIMIT, LIMIT - 1);
    i64::from(size) << BELOW | (part & ((1 << BELOW) - 1))
}

/// A drive within ±32 K.
fn bounded(drive: Celsius) -> i32 {
    const BOUND: i32 = Celsius::const_from_int(32).to_bits();
    drive.to_bits().clamp(-BOUND, BOUND - 1)
}

impl HalfSpace {
    /// The same surface, whose windows end half a window apart from this one's: two that are stepped together then
    /// never have a long tick together.
    #[must_use]
    pub fn staggered(&self) -> Self {
        let mut other = *self;
        other.end_window((self.to_come + WINDOW / 2 - 1) % WINDOW + 1);
        other
    }

    /// Where the surface is at the end of the coming tick if nothing flows in it.
    #[must_use]
    pub const fn free_response(&self) -> Celsius {
        self.left
    }

    /// Where the surface is at the end of a tick in which `drive` flows.
    #[must_use]
    pub fn response_to(&self, drive: Celsius) -> Celsius {
        let moved = product(bounded(drive), GAIN as i32) >> GAIN_BITS;
        self.left.saturating_add(Celsius::from_bits(moved as i32))
    }

    /// Lets a drive flow for one tick.
    pub fn step(&mut self, drive: Celsius) {
        let drive = bounded(drive);
        let mut left = Celsius::ZERO;
        for (state, part) in self.fast.iter_mut().zip(&FAST_PARTS) {
            *state += product(drive, part.given);
            *state += product(high(*state), -part.lost);
            left = left.saturating_add(Celsius::from_bits(high(*state)));
        }
        self.drives += drive;
        self.since += product(drive, SLOW_GIVEN) - self.loss;
        self.to_come -= 1;
        if self.to_come == 0 {
            self.end_window(WINDOW);
        }
        self.left = left.saturating_add(self.slow_left());
    }

    /// What is left of the slow parts.
    const fn slow_left(&self) -> Celsius {
        self.slow_sum
            .saturating_add(Celsius::from_bits(high(self.since)))
    }

    /// Steps the slow parts by those ticks of the window that have been. The next one has `ticks`.
    fn end_window(&mut self, ticks: u32) {
        let been = (self.window - self.to_come) as i32;
        let (mut sum, mut loss) = (Celsius::ZERO, 0i64);
        for (state, part) in self.slow.iter_mut().zip(&SLOW_PARTS) {
            *state += product(self.drives, part.given);
            *state = limited(*state - product(high(*state), part.lost / WINDOW as i32 * been));
            sum = sum.saturating_add(Celsius::from_bits(high(*state)));
            loss += product(high(*state), part.lost);
        }
        (self.slow_sum, self.since, self.loss) = (sum, 0, loss / i64::from(WINDOW));
        (self.drives, self.window, self.to_come) = (0, ticks, ticks);
    }

    /// The lasting drive that brings this surface in [`MATCH_HORIZON_TICKS`] to where another one, which has the same drive
    /// besides, will be.
    #[must_use]
    pub fn scaled_flux_to_match(&self, other: &Self) -> Celsius {
        let mut fast = 0;
        for ((from, to), part) in self.fast.iter().zip(&other.fast).zip(&FAST_PARTS) {
            fast += product(high(*to).saturating_sub(high(*from)), part.kept_ahead);
        }
        // The slow parts go on along their straight line.
        let lost = (other.loss - self.loss) * i64::from(MATCH_HORIZON_TICKS - 1);
        let slow = other.slow_left().saturating_sub(self.slow_left());
        let half = high(fast);
        let apart = half
            .saturating_add(half)
            .saturating_add(slow.to_bits())
            .saturating_sub(high(lost));
        Celsius::from_bits(high(product(apart, PER_GAIN_AHEAD)))
    }
}

#[cfg(test)]
mod tests;

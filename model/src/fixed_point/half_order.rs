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
//! Two half-spaces that touch share their flux, and so one sum serves both: their surfaces move in the ratio of
//! their effusivities, in opposite directions.

use super::{Celsius, Contact, Rate};

/// Relaxations, with rates of `2^-(2 k + 1)` a tick, and the integrator.
const PARTS: usize = 11;

/// One relaxation over one tick.
struct Part {
    /// Part of a drive that it takes up, in 2^-32.
    given: i32,
    /// Part of itself that it loses, in 2^-32.
    lost: i32,
    /// Part of itself that it loses in [`AHEAD_TICKS`], in 2^-30.
    lost_ahead: i32,
}

const fn part(given: i32, lost: i32, lost_ahead: i32) -> Part {
    Part {
        given,
        lost,
        lost_ahead,
    }
}

const PART: [Part; PARTS] = [
    part(1_054_608_677, 1_689_937_949, 1_073_693_077),
    part(629_882_806, 504_671_961, 985_603_728),
    part(329_854_396, 132_142_252, 499_009_242),
    part(166_864_942, 33_423_701, 155_321_772),
    part(83_677_061, 8_380_421, 41_134_391),
    part(41_869_179, 2_096_640, 10_434_726),
    part(20_938_423, 524_256, 2_618_243),
    part(10_469_691, 131_070, 655_160),
    part(5_234_905, 32_768, 163_828),
    part(2_617_460, 8_192, 40_959),
    part(2_670_177, 0, 0),
];

/// How far ahead [`HalfOrder::ahead`] looks.
pub const AHEAD_TICKS: u32 = 20;
/// What a drive of one kelvin moves the surface by in one tick, 1.183, in 2^-20.
const GAIN: u64 = 1_240_955;
/// The inverse of what a lasting drive of one kelvin moves it by in [`AHEAD_TICKS`], 1 / 5.060, in 2^-32.
const PER_GAIN_AHEAD: i64 = 848_763_970;
/// Binary places of a part below those of [`Celsius`].
const BELOW: u32 = 32;

/// How far the surface of a half-space has moved, tick by tick.
///
/// Its input is the *drive* `q sqrt(dt) / e`, in K. Under a constant drive the surface moves within 5 % of the
/// half-space in the first tick, 1.2 % in the second, 0.4 % from 10 to 6e4 ticks; what it leaves after 6e4 ticks is
/// within 0.6 % of what was (`cargo test -p contact-model half_order`). No input makes it overflow: it saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfOrder {
    /// K, 54 binary places.
    parts: [i64; PARTS],
    left: Celsius,
    ahead: Celsius,
}

impl Default for HalfOrder {
    fn default() -> Self {
        Self::at_rest()
    }
}

impl HalfOrder {
    /// No flux for ever.
    #[must_use]
    pub const fn at_rest() -> Self {
        Self {
            parts: [0; PARTS],
            left: Celsius::ZERO,
            ahead: Celsius::ZERO,
        }
    }

    /// Where the surface is at the end of the coming tick if nothing flows in it.
    #[must_use]
    pub const fn left(&self) -> Celsius {
        self.left
    }

    /// Where it is [`AHEAD_TICKS`] later if nothing flows.
    #[must_use]
    pub const fn ahead(&self) -> Celsius {
        self.ahead
    }

    /// Where the surface is at the end of a tick in which `drive` flows.
    #[must_use]
    pub fn after(&self, drive: Celsius) -> Celsius {
        let moved = (i64::from(drive.to_bits()) * GAIN as i64) >> 20;
        self.left.saturating_add(Celsius::from_bits(moved as i32))
    }

    /// Lets a drive flow for one tick.
    pub fn step(&mut self, drive: Celsius) {
        let drive = i64::from(drive.to_bits());
        let (mut sum, mut lost, mut lost_ahead) = (0i64, 0i64, 0i64);
        for (state, part) in self.parts.iter_mut().zip(&PART) {
            let change = drive * i64::from(part.given) - (*state >> BELOW) * i64::from(part.lost);
            *state = state.saturating_add(change);
            let high = *state >> BELOW;
            sum = sum.saturating_add(high);
            lost += high * i64::from(part.lost);
            lost_ahead += high * i64::from(part.lost_ahead);
        }
        let limit = |sum: i64| Celsius::from_bits(sum.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
        self.left = limit(sum - (lost >> BELOW));
        self.ahead = limit(sum - (lost_ahead >> (BELOW - 2)));
    }

    /// The lasting drive that brings this surface in [`AHEAD_TICKS`] to where another one, which has the same drive
    /// besides, will be.
    #[must_use]
    pub fn drive_to(&self, other: &Self) -> Celsius {
        let apart = i64::from(other.ahead.to_bits()) - i64::from(self.ahead.to_bits());
        Celsius::from_bits(((apart * PER_GAIN_AHEAD) >> 32) as i32)
    }
}

/// A contact resistance in front of a half-space: what flows through it in a tick, for a difference of temperatures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Link {
    /// Drive per kelvin between what is in front of the resistance and the surface without this tick's drive, 2^-32.
    per_k: u32,
    /// Temperature across the resistance per kelvin of drive, 2^-16.
    resistance: u32,
}

/// Binary places of a conductance here.
const CONDUCTANCE_BITS: u32 = 32;
/// No contact is as good as this: it would be perfect within 0.2 %.
const BEST: u64 = 1 << (CONDUCTANCE_BITS + 8);

impl Link {
    /// Of a conductance (drive per kelvin across it, 32 binary places) that is divided by `by` (likewise).
    fn new(conductance: u64, by: u64) -> Self {
        let conductance = conductance.min(BEST);
        let resistance_and_gain = by.saturating_add((GAIN * conductance) >> 20);
        let per_k = (conductance << 24) / (resistance_and_gain >> 8).max(1);
        let resistance = (by << 16).checked_div(conductance).unwrap_or(u64::MAX);
        Self {
            per_k: per_k.min(u64::from(u32::MAX)) as u32,
            resistance: resistance.min(u64::from(u32::MAX)) as u32,
        }
    }

    /// Drive of the coming tick, if `in_front` is what the surface would reach without a resistance.
    #[must_use]
    pub fn drive(&self, in_front: Celsius, body: &HalfOrder) -> Celsius {
        let across = i64::from(in_front.to_bits()) - i64::from(body.left().to_bits());
        let drive = (across * i64::from(self.per_k)) >> 32;
        Celsius::from_bits(drive.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }

    /// Temperature across the resistance under a drive.
    #[must_use]
    pub fn across(&self, drive: Celsius) -> Celsius {
        let across = (i64::from(drive.to_bits()) * i64::from(self.resistance)) >> 16;
        Celsius::from_bits(across.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}

/// `32` binary places; saturates at [`BEST`].
fn scaled(rate: Rate) -> u64 {
    let bits = 1 << 32 | u64::from(rate.fraction());
    match rate.exponent() {
        e @ 0..8 => bits << e,
        8.. => BEST,
        e => bits.checked_shr(e.unsigned_abs()).unwrap_or(0),
    }
}

impl Contact {
    /// The skin on the object, with both bodies as one: `in_front` is `w (T_skin,i - T_object,i)`, and what moves is
    /// the skin, downwards.
    #[must_use]
    pub fn on_object(&self) -> Link {
        Link::new(scaled(self.per_root_tick), 1 << CONDUCTANCE_BITS)
    }

    /// The skin on the display: `in_front` is `T_skin,i - T_display`.
    #[must_use]
    pub fn on_display(&self) -> Link {
        let weight = u64::from(self.weight.to_bits() >> 8);
        Link::new(
            (weight * scaled(self.per_root_tick)) >> 24,
            u64::from(self.ratio.to_bits()) << 4,
        )
    }
}

#[cfg(test)]
mod tests;

//! A resistance in front of a half-space.

use super::{GAIN, HalfOrder};
use crate::fixed_point::{Celsius, Contact, Rate};

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
        let resistance_and_gain = by.saturating_add((u64::from(GAIN) * conductance) >> 20);
        Self {
            per_k: quotient(conductance, resistance_and_gain, 32),
            resistance: quotient(by, conductance, 16),
        }
    }

    /// Drive of the coming tick, if `in_front` is what the surface would reach without a resistance.
    #[must_use]
    pub fn drive(&self, in_front: Celsius, body: &HalfOrder) -> Celsius {
        let across = in_front.saturating_sub(body.left());
        let drive = (i64::from(across.to_bits()) * i64::from(self.per_k)) >> 32;
        Celsius::from_bits(drive as i32)
    }

    /// Temperature across the resistance under a drive.
    #[must_use]
    pub fn across(&self, drive: Celsius) -> Celsius {
        let across = (i64::from(drive.to_bits()) * i64::from(self.resistance)) >> 16;
        Celsius::from_bits(across.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}

/// `a / b` in `2^-places`, in a division of 32 bits and a step of Newton's: a long one costs three hundred cycles.
/// Relative error below 2^-28, and less than one of the result's places; saturates.
fn quotient(a: u64, b: u64, places: i32) -> u32 {
    // The leading 32 bits of each: between a half and one.
    let (up, down) = (a.leading_zeros(), b.leading_zeros());
    let (Some(a), Some(b)) = (a.checked_shl(up), b.checked_shl(down)) else {
        return if a == 0 { 0 } else { u32::MAX };
    };
    let (a, b) = ((a >> 32) as u32, (b >> 32) as u32);
    // 2^48 / b within 2^-15 of itself, and 2^62 / b.
    let rough = i64::from(u32::MAX.checked_div(b >> 16).unwrap_or(u32::MAX));
    let missing = (1 << 48) - rough * i64::from(b);
    let inverse = (rough << 14) + ((rough * (missing >> 17)) >> 17);
    let size = (u64::from(a) * inverse.unsigned_abs()) >> 31;
    // In 2^-31, of the numbers as they were given.
    match 31 - places + up as i32 - down as i32 {
        right @ 0.. => size
            .checked_shr(right.unsigned_abs())
            .unwrap_or(0)
            .min(u64::from(u32::MAX)) as u32,
        left => u32::try_from(size)
            .ok()
            .filter(|size| size.leading_zeros() >= left.unsigned_abs())
            .map_or(u32::MAX, |size| size << left.unsigned_abs()),
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

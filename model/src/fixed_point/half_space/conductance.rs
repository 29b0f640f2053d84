//! A resistance in front of a half-space.

use super::{GAIN, GAIN_BITS, HalfSpace};
use crate::fixed_point::{Celsius, Contact, Fraction, MantissaExponent, Ratio};

/// A contact resistance in front of a half-space: what flows through it in a tick, for a difference of temperatures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactConductance {
    /// Drive per kelvin between what is in front of the resistance and the surface without this tick's drive, 2^-32.
    per_k: u32,
    /// Temperature across the resistance per kelvin of drive, 2^-16.
    resistance: u32,
}

/// Binary places of a resistance.
const RESISTANCE_BITS: u32 = 16;
/// [`GAIN`] in these, rounded.
const GAIN_HERE: u32 =
    (GAIN + (1 << (GAIN_BITS - RESISTANCE_BITS) >> 1)) >> (GAIN_BITS - RESISTANCE_BITS);

impl ContactConductance {
    /// Of a resistance; its conductance is right within 1e-5 of itself.
    const fn new(resistance: u32) -> Self {
        // 1.2 at least: up to 15 zeros before it.
        let in_all = resistance.saturating_add(GAIN_HERE);
        let up = in_all.leading_zeros();
        Self {
            per_k: inverse(in_all << up) << 1 >> (15 - up),
            resistance,
        }
    }

    /// Drive of the coming tick, if `in_front` is what the surface would reach without a resistance.
    #[must_use]
    pub fn scaled_flux(&self, in_front: Celsius, body: &HalfSpace) -> Celsius {
        let across = in_front.saturating_sub(body.free_response());
        let drive = (i64::from(across.to_bits()) * i64::from(self.per_k)) >> 32;
        Celsius::from_bits(drive as i32)
    }

    /// Temperature across the resistance under a drive.
    #[must_use]
    pub fn temperature_drop(&self, drive: Celsius) -> Celsius {
        let across = (i64::from(drive.to_bits()) * i64::from(self.resistance)) >> 16;
        Celsius::from_bits(across.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}

/// `2^62 / n` for `n` from 2^31 on: below 2^31, relative error below 2^-28. A division of 32 bits and a step of
/// Newton's, because a long division costs three hundred cycles.
pub(super) const fn inverse(n: u32) -> u32 {
    // 2^48 / n, within 2^-15 of itself.
    let rough = (u32::MAX / (n >> 16 | 1 << 15)) as i64;
    let missing = (1 << 48) - rough * n as i64;
    ((rough << 14) + ((rough * (missing >> 17)) >> 17)) as u32
}

/// `ratio / (rate part)`, 16 binary places; saturates.
fn resistance(ratio: Ratio, rate: MantissaExponent, part: Fraction) -> u32 {
    let product = u64::from(rate.leading()) * u64::from(part.to_bits());
    let up = product.leading_zeros();
    let Some(leading) = product.checked_shl(up) else {
        return u32::MAX;
    };
    let size = u64::from(ratio.to_bits()) * u64::from(inverse((leading >> 32) as u32));
    // From the places of the ratio and the inverse to those of a resistance; the product's are 31 and 32, and
    // 32 of its bits are not in the inverse.
    const DOWN: i32 = Ratio::FRAC_NBITS as i32 + 62 - (31 + 32 - 32) - RESISTANCE_BITS as i32;
    match DOWN + rate.exponent() - up as i32 {
        _ if size == 0 => 0,
        64.. => 0,
        down @ 0..64 => (size >> down).min(u64::from(u32::MAX)) as u32,
        _ => u32::MAX,
    }
}

impl Contact {
    /// The skin on the object, with both bodies as one: `in_front` is `w (T_skin,i - T_object,i)`, and what moves is
    /// the skin, downwards.
    #[must_use]
    pub fn object_conductance(&self) -> ContactConductance {
        ContactConductance::new(resistance(
            Ratio::ONE,
            self.root_rate_per_tick,
            Fraction::MAX,
        ))
    }

    /// The skin on the display: `in_front` is `T_skin,i - T_display`.
    #[must_use]
    pub fn display_conductance(&self) -> ContactConductance {
        ContactConductance::new(resistance(self.ratio, self.root_rate_per_tick, self.weight))
    }
}

//! The response to contact, Eq. 6-5 to 6-7 and 6-12.

use super::{Celsius, Flux, Fraction, MantissaExponent, Ratio, Ticks, erfcx};

/// A finger on an object under constant pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// `e_object / (e_object + e_skin)`.
    pub weight: Fraction,
    /// `R_display / R_object`.
    pub ratio: Ratio,
    /// `b² dt`.
    pub rate_per_tick: MantissaExponent,
    /// `b sqrt(dt)`.
    pub root_rate_per_tick: MantissaExponent,
    /// `1 / R`, W/(m² K); below 2^-33 no difference gives a flux that [`Flux`] could hold.
    pub conductance_w_m2k: MantissaExponent,
}

/// `E` of one moment, and what it gives: each output is computed when it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    contact: Contact,
    skin_before: Celsius,
    object_before: Celsius,
    erfcx: Fraction,
}

impl Contact {
    /// State `elapsed` ticks after landing, from the temperatures before it; holds from [`Ticks::MAX`] on.
    #[must_use]
    #[inline]
    pub fn at(&self, elapsed: u32, skin_before: Celsius, object_before: Celsius) -> Response {
        Response {
            contact: *self,
            skin_before,
            object_before,
            erfcx: Ticks::new(elapsed.min(Ticks::MAX.get()))
                .map_or(Fraction::MAX, |elapsed| erfcx(elapsed, self.rate_per_tick)),
        }
    }
}

/// Outputs, for temperatures within [`super::TEMPERATURE_RANGE_C`] and steps `dT` up to 60 K, with `e` the error
/// of `E` ([`erfcx`]'s own and 0.14 of the relative error of `rate_per_tick`). Beyond, errors grow with `dT`; nothing
/// wraps.
impl Response {
    /// `erfcx(b sqrt(t))`.
    #[must_use]
    pub const fn erfcx(&self) -> Fraction {
        self.erfcx
    }

    /// Skin surface (Eq. 6-5); error below 0.2 µK + `w e dT`.
    #[must_use]
    pub fn skin(&self) -> Celsius {
        self.skin_before
            .saturating_sub(part(self.step(), self.skin_part()))
    }

    /// Object surface (Eq. 6-6); error below 0.2 µK + `(1 - w) e dT`.
    #[must_use]
    pub fn object(&self) -> Celsius {
        let object_part = self.done().saturating_sub(self.skin_part());
        self.object_before
            .saturating_add(part(self.step(), object_part))
    }

    /// Display surface that puts the skin where the object would (Eq. 6-12); error below
    /// 0.6 µK + `|r - w| e dT`.
    #[must_use]
    pub fn display(&self) -> Celsius {
        // `w (1 - E) + r E` lies between w and r, so that 60 fraction bits fit below 16.
        let (weight, done) = (self.contact.weight.to_bits(), self.done().to_bits());
        let (ratio, left) = (self.contact.ratio.to_bits(), self.erfcx.to_bits());
        let gain =
            ((u64::from(weight) * u64::from(done)) >> 4) + u64::from(ratio) * u64::from(left);
        let gain = (gain + (1 << 32)) >> 33;
        let change = i64::from(self.step().to_bits()) * i64::from(gain as i32);
        less::<27>(self.skin_before, change)
    }

    /// Heat flux out of the skin (Eq. 6-7, positive for a cold object); error below `dT / R` times the sum of
    /// `e`, 2^-30 and the relative error of the conductance, and the resolution of [`Flux`]. Saturates at
    /// 5e11 W/m².
    #[must_use]
    pub fn flux_w_m2(&self) -> Flux {
        flux(
            i64::from(self.step().to_bits()) * i64::from(self.erfcx.to_bits()),
            self.contact.conductance_w_m2k,
        )
    }

    fn step(&self) -> Celsius {
        self.skin_before.saturating_sub(self.object_before)
    }

    /// `1 - E`, where the largest `E` counts as one.
    fn done(&self) -> Fraction {
        !self.erfcx
    }

    /// `w (1 - E)`.
    fn skin_part(&self) -> Fraction {
        product(self.contact.weight, self.done())
    }
}

/// The product of two fractions; error at most half of the resolution.
#[inline]
pub(super) fn product(a: Fraction, b: Fraction) -> Fraction {
    let bits = u64::from(a.to_bits()) * u64::from(b.to_bits());
    Fraction::from_bits(((bits + (1 << 31)) >> 32) as u32)
}

/// `from` less a change with `BITS` more fraction bits; error at most half of the resolution; saturates.
#[inline]
pub(super) fn less<const BITS: u32>(from: Celsius, change: i64) -> Celsius {
    let rounded = change.saturating_add(1 << BITS >> 1) >> BITS;
    let bits = i64::from(from.to_bits()).saturating_sub(rounded);
    let low = bits as i32;
    // Shorter than a clamp in 64 bits: what does not fit has the sign of its high half.
    let end = (bits >> 63) as i32 ^ i32::MAX;
    Celsius::from_bits(if i64::from(low) == bits { low } else { end })
}

/// `fraction` of a temperature difference; error at most half of its resolution.
#[inline]
pub(super) fn part(difference: Celsius, fraction: Fraction) -> Celsius {
    let product = i64::from(difference.to_bits()) * i64::from(fraction.to_bits());
    Celsius::from_bits((product.saturating_add(1 << 31) >> 32) as i32)
}

/// Eq. 6-12 at landing.
pub(super) fn preset(ratio: Ratio, skin_c: Celsius, object_c: Celsius) -> Celsius {
    let step = skin_c.saturating_sub(object_c);
    less::<{ Ratio::FRAC_NBITS }>(
        skin_c,
        i64::from(step.to_bits()) * i64::from(ratio.to_bits()),
    )
}

/// Eq. 3-1: where both surfaces go for a part `weight` of the way from skin to object.
pub(super) fn interface(weight: Fraction, skin_c: Celsius, object_c: Celsius) -> Celsius {
    skin_c.saturating_sub(part(skin_c.saturating_sub(object_c), weight))
}

/// Flux from a temperature difference with 54 fraction bits and a conductance; relative error below 2^-30,
/// rounded towards zero; saturates.
pub(super) fn flux(difference: i64, conductance_w_m2k: MantissaExponent) -> Flux {
    let magnitude = difference.unsigned_abs();
    let zeros = magnitude.leading_zeros();
    let leading = (magnitude.checked_shl(zeros).unwrap_or(0) >> 32) as u32;
    let product = u64::from(leading) * u64::from(conductance_w_m2k.leading());
    // Fraction bits of the difference, without those cut off, and of the mantissa, to those of the flux.
    let shift =
        54 - (32 - zeros as i32) + 31 - Flux::FRAC_NBITS as i32 - conductance_w_m2k.exponent();
    let bits = match shift {
        64.. => 0,
        1..64 => (product >> shift) as i64,
        _ if product == 0 => 0,
        _ => i64::MAX,
    };
    Flux::from_bits(if difference < 0 { -bits } else { bits })
}

//! The response to contact, Eq. 6-5 to 6-7 and 6-12.

use super::{Celsius, Flux, Fraction, Rate, Ratio, Ticks, erfcx};

/// A finger on an object under constant pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// `e_object / (e_object + e_skin)`.
    pub weight: Fraction,
    /// `R_display / R_object`.
    pub ratio: Ratio,
    /// `b² dt`.
    pub per_tick: Rate,
    /// `1 / R`, W/(m² K).
    pub conductance_w_m2k: Rate,
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
                .map_or(Fraction::MAX, |elapsed| erfcx(elapsed, self.per_tick)),
        }
    }
}

/// Outputs; for temperatures within [`super::TEMPERATURE_RANGE_C`] their error is that of `E` (below 2^-28) times
/// the temperature step, plus at most 1 µK.
impl Response {
    /// `erfcx(b sqrt(t))`.
    #[must_use]
    pub const fn erfcx(&self) -> Fraction {
        self.erfcx
    }

    /// Skin surface (Eq. 6-5).
    #[must_use]
    pub fn skin(&self) -> Celsius {
        let full = part(self.step(), self.contact.weight);
        self.skin_before
            .saturating_sub(full)
            .saturating_add(part(full, self.erfcx))
    }

    /// Object surface (Eq. 6-6).
    #[must_use]
    pub fn object(&self) -> Celsius {
        let full = self.step().saturating_sub(part(self.step(), self.contact.weight));
        self.object_before
            .saturating_add(full)
            .saturating_sub(part(full, self.erfcx))
    }

    /// Display surface that puts the skin where the object would (Eq. 6-12).
    #[must_use]
    pub fn display(&self) -> Celsius {
        let across = part(self.step(), self.erfcx);
        self.skin().saturating_sub(scaled(across, self.contact.ratio))
    }

    /// Heat flux out of the skin (Eq. 6-7, positive for a cold object); relative error below 2^-20 of
    /// `dT / R`. Saturates at 5e11 W/m².
    #[must_use]
    pub fn flux_w_m2(&self) -> Flux {
        let across = part(self.step(), self.erfcx);
        let product =
            i64::from(across.to_bits()) * i64::from(1 << 31 | self.contact.conductance_w_m2k.fraction() >> 1);
        // 22 fraction bits of temperature and 31 of the mantissa, to the 24 of the result.
        let shift = 22 + 31 - 24 - self.contact.conductance_w_m2k.exponent();
        Flux::from_bits(match shift {
            64.. => 0,
            0..64 => product >> shift,
            _ => product.saturating_mul(1i64.checked_shl(shift.unsigned_abs()).unwrap_or(i64::MAX)),
        })
    }

    fn step(&self) -> Celsius {
        self.skin_before.saturating_sub(self.object_before)
    }
}

/// `fraction` of a temperature difference, rounded down to its resolution.
#[inline]
pub(super) fn part(difference: Celsius, fraction: Fraction) -> Celsius {
    Celsius::from_bits(((i64::from(difference.to_bits()) * i64::from(fraction.to_bits())) >> 32) as i32)
}

/// A temperature difference times `R_display / R_object`; saturates.
pub(super) fn scaled(difference: Celsius, ratio: Ratio) -> Celsius {
    let bits = (i64::from(difference.to_bits()) * i64::from(ratio.to_bits())) >> 28;
    Celsius::from_bits(bits.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32)
}

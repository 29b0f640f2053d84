//! Temperatures and heat flux during contact (Eq. 6-5 to 6-7 and 6-12).

use super::{Celsius, Flux, Fraction, MantissaExponent, Ratio, Ticks, erfcx};

/// Parameters of a finger in contact with an object under constant pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// Weight of the object's temperature in that of the interface (Eq. 3-1), `w = e_object / (e_object + e_skin)`.
    pub weight: Fraction,
    /// Ratio of contact resistances, `r = R_display / R_object`.
    pub ratio: Ratio,
    /// `b² dt`, dimensionless, with `b = (1/e_skin + 1/e_object) / R` and the tick `dt`.
    pub rate_per_tick: MantissaExponent,
    /// `b sqrt(dt)`, dimensionless.
    pub root_rate_per_tick: MantissaExponent,
    /// Contact conductance `1 / R`, W/(m² K). Below 2^-33 every flux is below the resolution of [`Flux`].
    pub conductance_w_m2k: MantissaExponent,
}

/// State of a contact at one time. `E` is evaluated once; each output is computed when it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    contact: Contact,
    skin_before: Celsius,
    object_before: Celsius,
    erfcx: Fraction,
}

impl Contact {
    /// State `elapsed` ticks after landing, from the temperatures before landing; constant from [`Ticks::MAX`] on.
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

/// Error bounds hold for temperatures within [`super::TEMPERATURE_RANGE_C`] that differ by `dT` of at most 60 K.
/// `e` is the error of `E`: that of [`erfcx`] and 0.14 times the relative error of `rate_per_tick`. Beyond these
/// ranges errors grow with `dT`, and the outputs saturate.
impl Response {
    /// `E = erfcx(b sqrt(t))`: 1 at landing, 0 after a long time.
    pub const fn erfcx(&self) -> Fraction {
        self.erfcx
    }

    /// Surface temperature of the skin, °C (Eq. 6-5); error below 0.2 µK + `w e dT`.
    pub fn skin(&self) -> Celsius {
        self.skin_before.saturating_sub(fraction_of(self.difference(), self.skin_part()))
    }

    /// Surface temperature of the object, °C (Eq. 6-6); error below 0.2 µK + `(1 - w) e dT`.
    pub fn object(&self) -> Celsius {
        let object_part = self.one_less_erfcx().saturating_sub(self.skin_part());
        self.object_before.saturating_add(fraction_of(self.difference(), object_part))
    }

    /// Temperature of the display's surface at which the skin has the temperature it has on the object, °C
    /// (Eq. 6-12); error below 0.6 µK + `|r - w| e dT`.
    pub fn display(&self) -> Celsius {
        // `w (1 - E) + r E` lies between w and r, below 16, so 60 binary places fit in 64 bits.
        let by_weight = self.contact.weight.wide_mul(self.one_less_erfcx()).to_bits();
        let by_ratio = self.contact.ratio.wide_mul(self.erfcx).to_bits();
        let factor = (by_weight >> 4) + by_ratio;
        let factor = (factor + (1 << 32)) >> 33;
        let change = i64::from(self.difference().to_bits()) * i64::from(factor as i32);
        subtract_rounded::<27>(self.skin_before, change)
    }

    /// Heat flux out of the skin, W/m² (Eq. 6-7, positive for a cold object); error below `dT / R` times the sum of
    /// `e`, 2^-30 and the relative error of the conductance, and the resolution of [`Flux`]. Saturates at
    /// ±5e11 W/m².
    pub fn flux_w_m2(&self) -> Flux {
        flux(
            i64::from(self.difference().to_bits()) * i64::from(self.erfcx.to_bits()),
            self.contact.conductance_w_m2k,
        )
    }

    /// `dT`, the temperature difference of skin and object before landing.
    fn difference(&self) -> Celsius {
        self.skin_before.saturating_sub(self.object_before)
    }

    /// `1 - E`; the largest [`Fraction`] stands for `E = 1`.
    fn one_less_erfcx(&self) -> Fraction {
        !self.erfcx
    }

    /// `w (1 - E)`, the change of the skin's surface as a fraction of `dT`.
    fn skin_part(&self) -> Fraction {
        fraction_product(self.contact.weight, self.one_less_erfcx())
    }
}

/// The product of two fractions; error at most half of the resolution.
#[inline]
fn fraction_product(a: Fraction, b: Fraction) -> Fraction {
    let bits = u64::from(a.to_bits()) * u64::from(b.to_bits());
    Fraction::from_bits(((bits + (1 << 31)) >> 32) as u32)
}

/// `from - change`, for a change with `BITS` more binary places; error at most half of the resolution; saturates.
#[inline]
pub(super) fn subtract_rounded<const BITS: u32>(from: Celsius, change: i64) -> Celsius {
    let rounded = change.saturating_add(1 << BITS >> 1) >> BITS;
    let bits = i64::from(from.to_bits()).saturating_sub(rounded);
    let low = bits as i32;
    // Fewer instructions than a 64-bit clamp: the sign of the sum selects the end of the range.
    let end = (bits >> 63) as i32 ^ i32::MAX;
    Celsius::from_bits(if i64::from(low) == bits { low } else { end })
}

/// `fraction` times a temperature difference; error at most half of the resolution.
#[inline]
pub(super) fn fraction_of(difference: Celsius, fraction: Fraction) -> Celsius {
    let product = i64::from(difference.to_bits()) * i64::from(fraction.to_bits());
    Celsius::from_bits((product.saturating_add(1 << 31) >> 32) as i32)
}

/// Display temperature at landing, °C (Eq. 6-12 at `t = 0`), for a ratio of the resistances of display and object, from the
/// temperatures of skin and object before contact, °C.
pub fn preset(ratio: Ratio, skin_c: Celsius, object_c: Celsius) -> Celsius {
    let difference = skin_c.saturating_sub(object_c);
    subtract_rounded::<{ Ratio::FRAC_NBITS }>(
        skin_c,
        i64::from(difference.to_bits()) * i64::from(ratio.to_bits()),
    )
}

/// Temperature of both surfaces in perfect contact, °C (Eq. 3-1).
pub(super) fn interface(weight: Fraction, skin_c: Celsius, object_c: Celsius) -> Celsius {
    skin_c.saturating_sub(fraction_of(skin_c.saturating_sub(object_c), weight))
}

/// Heat flux, W/m², from a temperature difference (K, 54 binary places) and a conductance; relative error below
/// 2^-30, rounded towards zero; saturates.
fn flux(difference: i64, conductance_w_m2k: MantissaExponent) -> Flux {
    let magnitude = difference.unsigned_abs();
    let zeros = magnitude.leading_zeros();
    let leading = (magnitude.checked_shl(zeros).unwrap_or(0) >> 32) as u32;
    let product = u64::from(leading) * u64::from(conductance_w_m2k.leading());
    // From the binary places of the difference, less those cut off, and of the mantissa to those of the flux.
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

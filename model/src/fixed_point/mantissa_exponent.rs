//! Positive numbers over a wide range.

use super::{Log2, exp2};

/// A positive number `(1 + fraction / 2^32) 2^exponent`: 33 significant bits, exponent within ±16384, where it
/// saturates.
///
/// Holds `b² dt` (per tick) and contact conductances (W/(m² K)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MantissaExponent {
    fraction: u32,
    /// Held in a word because the kernel adds to it.
    exponent: i32,
}

/// Far beyond every contact, and within `i16`.
const EXPONENT_MAX: i32 = 1 << 14;

impl MantissaExponent {
    /// The number one.
    pub const ONE: Self = Self::new(0, 0);

    /// `(1 + fraction / 2^32) 2^exponent`.
    #[must_use]
    pub const fn new(exponent: i16, fraction: u32) -> Self {
        Self::clamped(fraction, exponent as i32)
    }

    const fn clamped(fraction: u32, exponent: i32) -> Self {
        let exponent = if exponent > EXPONENT_MAX {
            EXPONENT_MAX
        } else if exponent < -EXPONENT_MAX {
            -EXPONENT_MAX
        } else {
            exponent
        };
        Self { fraction, exponent }
    }

    /// Rounds a positive, normal number (relative error at most 2^-33); `None` for anything else.
    #[must_use]
    pub fn from_f64(value: f64) -> Option<Self> {
        if !value.is_normal() || value < 0.0 {
            return None;
        }
        let bits = value.to_bits();
        // 52 fraction bits rounded to 32; a carry out of the fraction doubles the number.
        let rounded = (bits + (1 << 19)) >> 20;
        Some(Self::clamped(rounded as u32, (rounded >> 32) as i32 - 1023))
    }

    /// Two to the power of `log2`; relative error below 1.4 * 2^-32.
    #[must_use]
    pub fn from_log2(log2: Log2) -> Self {
        let bits = log2.to_bits();
        Self::clamped(exp2(bits as u32), (bits >> 32) as i32)
    }

    /// The product; relative error below 2^-32.
    #[must_use]
    pub const fn times(self, other: Self) -> Self {
        let (a, b) = (self.fraction as u64, other.fraction as u64);
        // The product of the mantissas, in 1..4 with 32 fraction bits.
        let product = (1 << 32) + a + b + ((a * b + (1 << 31)) >> 32);
        let exponent = self.exponent + other.exponent;
        if product >> 33 == 0 {
            Self::clamped(product as u32, exponent)
        } else {
            Self::clamped((product >> 1) as u32, exponent + 1)
        }
    }

    /// The number, exactly, where `f64` can hold it.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        libm::ldexp(
            f64::from(self.fraction) + 4_294_967_296.0,
            self.exponent - 32,
        )
    }

    /// The 32 bits after the leading one.
    #[must_use]
    pub const fn fraction(self) -> u32 {
        self.fraction
    }

    /// Floor of the logarithm to base 2.
    #[must_use]
    pub const fn exponent(self) -> i32 {
        self.exponent
    }

    /// The leading one and the 31 bits after it; relative error below 2^-31.
    pub(super) const fn leading(self) -> u32 {
        1 << 31 | self.fraction >> 1
    }

    /// The number times a power of two, exactly.
    #[must_use]
    #[inline]
    pub const fn times_power_of_2(self, times: i16) -> Self {
        Self::clamped(self.fraction, self.exponent + times as i32)
    }

    /// The number times two, without the limit of the exponent: for a few dozen times.
    pub(super) const fn twice(self) -> Self {
        Self {
            fraction: self.fraction,
            exponent: self.exponent.wrapping_add(1),
        }
    }
}

//! Positive numbers over a wide range, as mantissa and exponent.

use super::{Log2, exp2};

/// A positive number `(1 + fraction / 2^32) 2^exponent`: 33 significant bits, exponent within ±16384, where it
/// saturates.
///
/// For `b² dt` (per tick) and contact conductances (W/(m² K)), which span more than 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MantissaExponent {
    fraction: u32,
    /// Not `i16`, because the kernel adds to it in 32 bits.
    exponent: i32,
}

/// Limit of the exponent: beyond every contact, and within `i16`.
const EXPONENT_MAX: i32 = 1 << 14;

impl MantissaExponent {
    /// The number 1.
    pub const ONE: Self = Self::new(0, 0);

    /// `(1 + fraction / 2^32) 2^exponent`.
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

    /// Rounds a positive, normal number; relative error at most 2^-33. `None` for any other.
    pub fn from_f64(value: f64) -> Option<Self> {
        if !value.is_normal() || value < 0.0 {
            return None;
        }
        let bits = value.to_bits();
        // 52 fraction bits are rounded to 32; a carry out of them increments the exponent.
        let rounded = (bits + (1 << 19)) >> 20;
        Some(Self::clamped(rounded as u32, (rounded >> 32) as i32 - 1023))
    }

    /// Two to the power of `log2`; relative error below 1.4 * 2^-32.
    pub fn from_log2(log2: Log2) -> Self {
        let bits = log2.to_bits();
        Self::clamped(exp2(bits as u32), (bits >> 32) as i32)
    }

    /// Product; relative error below 2^-32.
    #[inline(never)]
    pub const fn times(self, other: Self) -> Self {
        let (a, b) = (self.fraction as u64, other.fraction as u64);
        // Product of the mantissas, from 1 to 4, with 32 binary places.
        let product = (1 << 32) + a + b + ((a * b + (1 << 31)) >> 32);
        let exponent = self.exponent + other.exponent;
        if product >> 33 == 0 {
            Self::clamped(product as u32, exponent)
        } else {
            Self::clamped((product >> 1) as u32, exponent + 1)
        }
    }

    /// Converts exactly, within the range of `f64`.
    pub fn to_f64(self) -> f64 {
        libm::ldexp(f64::from(self.fraction) + 4_294_967_296.0, self.exponent - 32)
    }

    /// The 32 bits after the leading one of the mantissa.
    pub const fn fraction(self) -> u32 {
        self.fraction
    }

    /// Exponent: `log2` of the number, rounded down.
    pub const fn exponent(self) -> i32 {
        self.exponent
    }

    /// Mantissa from 1 to 2, in units of 2^-31, rounded down; relative error below 2^-31.
    pub(super) const fn leading(self) -> u32 {
        1 << 31 | self.fraction >> 1
    }

    /// The number times `2^exponent`, exact within the range of the exponent.
    #[inline]
    pub const fn times_power_of_2(self, exponent: i16) -> Self {
        Self::clamped(self.fraction, self.exponent + exponent as i32)
    }

    /// The number times 2. The exponent is not limited, so it is for few uses in succession.
    pub(super) const fn twice(self) -> Self {
        Self { fraction: self.fraction, exponent: self.exponent.wrapping_add(1) }
    }
}

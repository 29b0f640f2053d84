//! Positive numbers over a wide range.

use super::{Log2, exp2};

/// A positive number `(1 + fraction / 2^32) 2^exponent`: 33 significant bits.
///
/// Holds `b² dt` (per tick) and contact conductances (W/(m² K)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    fraction: u32,
    exponent: i16,
}

impl Rate {
    /// The number one.
    pub const ONE: Self = Self {
        fraction: 0,
        exponent: 0,
    };

    /// Rounds a positive, normal number; `None` for anything else.
    #[must_use]
    pub fn from_f64(value: f64) -> Option<Self> {
        if !value.is_normal() || value < 0.0 {
            return None;
        }
        let bits = value.to_bits();
        // 52 fraction bits rounded to 32; a carry out of the fraction doubles the number.
        let rounded = (bits + (1 << 19)) >> 20;
        Some(Self {
            fraction: rounded as u32,
            exponent: (rounded >> 32) as i16 - 1023,
        })
    }

    /// Two to the power of `log2`, relative error below 2^-23.
    #[must_use]
    pub fn from_log2(log2: Log2) -> Self {
        let whole = log2.to_bits() >> 24;
        Self {
            fraction: exp2((log2.to_bits() as u32) << 8) << 1,
            exponent: whole as i16,
        }
    }

    /// The number, exactly.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        libm::ldexp(
            f64::from(self.fraction) + 4_294_967_296.0,
            i32::from(self.exponent) - 32,
        )
    }

    /// The 32 bits after the leading one.
    #[must_use]
    pub const fn fraction(self) -> u32 {
        self.fraction
    }

    /// Floor of the logarithm to base 2.
    #[must_use]
    pub const fn exponent(self) -> i16 {
        self.exponent
    }

    /// The number times a power of two.
    #[must_use]
    #[inline]
    pub const fn doubled(self, times: i16) -> Self {
        Self {
            fraction: self.fraction,
            exponent: self.exponent.saturating_add(times),
        }
    }
}

//! Positive numbers over a wide range.

use super::{Log2, exp2};

/// A positive number `mantissa * 2^(exponent - 31)` with `mantissa` in `2^31..2^32`: 32 significant bits.
///
/// Holds `b² dt` (per tick) and contact conductances (W/(m² K)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    mantissa: u32,
    exponent: i16,
}

impl Rate {
    /// The number one.
    pub const ONE: Self = Self {
        mantissa: 1 << 31,
        exponent: 0,
    };

    /// Rounds a positive, normal number; `None` for anything else.
    #[must_use]
    pub fn from_f64(value: f64) -> Option<Self> {
        if !value.is_normal() || value < 0.0 {
            return None;
        }
        let bits = value.to_bits();
        let exponent = (bits >> 52) as i16 - 1023;
        // 52 fraction bits rounded to 31; a carry out of the fraction doubles the number.
        let fraction = ((bits & ((1 << 52) - 1)) + (1 << 20)) >> 21;
        Some(if fraction >> 31 == 0 {
            Self {
                mantissa: 1 << 31 | fraction as u32,
                exponent,
            }
        } else {
            Self {
                mantissa: 1 << 31,
                exponent: exponent + 1,
            }
        })
    }

    /// Two to the power of `log2`, relative error below 2^-23.
    #[must_use]
    pub fn from_log2(log2: Log2) -> Self {
        let whole = log2.to_bits() >> 24;
        Self {
            mantissa: exp2((log2.to_bits() as u32) << 8),
            exponent: whole as i16,
        }
    }

    /// The number, exactly.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        libm::ldexp(f64::from(self.mantissa), i32::from(self.exponent) - 31)
    }

    /// Leading 32 bits, `2^31..2^32`.
    #[must_use]
    pub const fn mantissa(self) -> u32 {
        self.mantissa
    }

    /// Floor of the logarithm to base 2.
    #[must_use]
    pub const fn exponent(self) -> i16 {
        self.exponent
    }
}

//! Decimal text of `f64` numbers with the digits that they have, for messages.
//!
//! The core library's own text of an `f64` holds for every magnitude up to 1e308, which takes 24 KB of a microcontroller's
//! flash.

use core::fmt;

/// Most decimals of a number.
const DECIMALS_MAX: usize = 9;
/// Powers of ten by their exponent.
const POWERS_OF_TEN: [u32; DECIMALS_MAX + 1] = {
    let mut powers = [1; DECIMALS_MAX + 1];
    let mut exponent = 1;
    while exponent <= DECIMALS_MAX {
        powers[exponent] = 10 * powers[exponent - 1];
        exponent += 1;
    }
    powers
};

/// A number that `Display` writes with a given number of decimals, 0 to 9, as `{:.3}` writes one with three: rounded exactly to
/// the nearest, ties to even. A magnitude of 2^32 or more is written as 4294967295.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded(pub f64, pub usize);

/// A number that `Display` writes with as few decimals as it can be read back from, as `{}` does, but with at most nine.
/// A magnitude of 2^32 or more is written as 4294967295.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortest(pub f64);

impl fmt::Display for Rounded {
    #[inline(never)]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value, decimals) = *self;
        if value.is_nan() {
            return f.write_str("NaN");
        }
        if value.is_sign_negative() {
            f.write_str("-")?;
        }
        if value.is_infinite() {
            return f.write_str("inf");
        }
        let (whole, fraction) = self.whole_and_fraction();
        whole.fmt(f)?;
        let decimals = decimals.min(DECIMALS_MAX);
        if decimals > 0 {
            write!(f, ".{fraction:0decimals$}")?;
        }
        Ok(())
    }
}

impl Rounded {
    /// The digits of the magnitude before the decimal point and behind it, for code that writes them itself; of infinity and NaN those
    /// of the largest number.
    #[inline(never)]
    pub fn whole_and_fraction(&self) -> (u32, u32) {
        let decimals = self.1.min(DECIMALS_MAX);
        let power = u64::from(POWERS_OF_TEN[decimals]);
        let scaled = nearest_multiple(self.0, decimals);
        match u32::try_from(scaled / power) {
            Ok(whole) => (whole, (scaled % power) as u32),
            Err(_) => (u32::MAX, 0),
        }
    }
}

impl fmt::Display for Shortest {
    #[inline(never)]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        let reads_back = |decimals: &usize| {
            let read =
                nearest_multiple(value, *decimals) as f64 / f64::from(POWERS_OF_TEN[*decimals]);
            read == value.abs()
        };
        let decimals = (0..DECIMALS_MAX).find(reads_back);
        Rounded(value, decimals.unwrap_or(DECIMALS_MAX)).fmt(f)
    }
}

/// Magnitude of a number in units of its last decimal, rounded to the nearest, ties to even; saturates.
#[inline(never)]
fn nearest_multiple(value: f64, decimals: usize) -> u64 {
    // value = mantissa / 2^shift; subnormal numbers round to zero in any case.
    let bits = value.abs().to_bits();
    let mantissa = bits & ((1 << (f64::MANTISSA_DIGITS - 1)) - 1) | 1 << (f64::MANTISSA_DIGITS - 1);
    let exponent = (bits >> (f64::MANTISSA_DIGITS - 1)) as u32;
    let Some(shift) = 1075u32.checked_sub(exponent).filter(|shift| *shift > 0) else {
        return u64::MAX;
    };
    // Below 2^83.
    let product = u128::from(mantissa) * u128::from(POWERS_OF_TEN[decimals % POWERS_OF_TEN.len()]);
    if shift >= 100 {
        return 0;
    }
    let whole = u64::try_from(product >> shift).unwrap_or(u64::MAX);
    let above_half = (product << (128 - shift)).cmp(&(1 << 127));
    let up = above_half.is_gt() || above_half.is_eq() && whole % 2 == 1;
    whole.saturating_add(u64::from(up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::format;
    use std::string::ToString;

    #[test]
    fn special_values_are_written_as_by_the_core_library() {
        for value in [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MIN_POSITIVE,
            5e-324,
        ] {
            for decimals in 0..=DECIMALS_MAX {
                assert_eq!(Rounded(value, decimals).to_string(), format!("{value:.decimals$}"));
            }
        }
        for value in [
            0.0,
            -0.0,
            0.001,
            -0.05,
            1e-6,
            15.0,
            42.0,
            1.3e7,
            27e3,
            8_000_000.25,
            f64::NAN,
            f64::INFINITY,
        ] {
            assert_eq!(Shortest(value).to_string(), format!("{value}"));
        }
        assert_eq!(Rounded(1e300, 2).to_string(), "4294967295.00");
        assert_eq!(Shortest(-1e10).to_string(), "-4294967295");
        assert_eq!(Shortest(1.0 / 3.0).to_string(), "0.333333333");
    }

    /// More units than 64 bits hold saturate; what is written is the largest whole part that [`Rounded`] documents.
    #[test]
    fn a_number_of_more_units_than_64_bits_hold_saturates() {
        for value in [18_446_744_074.0, 1e12, 1e300] {
            assert_eq!(nearest_multiple(value, 9), u64::MAX, "{value}");
        }
        assert_eq!(nearest_multiple(18_446_744_073.0, 9), 18_446_744_073_000_000_000);
    }

    proptest! {
        #[test]
        fn numbers_are_rounded_as_by_the_core_library(mantissa in any::<i64>(), exponent in -90i32..=-31, decimals in 0..=DECIMALS_MAX) {
            let value = mantissa as f64 * f64::powi(2.0, exponent);
            prop_assert_eq!(Rounded(value, decimals).to_string(), format!("{value:.decimals$}"));
        }

        /// Halves, quarters and so on: the last decimal is often a tie.
        #[test]
        fn ties_are_rounded_as_by_the_core_library(eighths in -100_000i32..100_000, decimals in 0..=3usize) {
            let value = f64::from(eighths) / 8.0;
            prop_assert_eq!(Rounded(value, decimals).to_string(), format!("{value:.decimals$}"));
        }

        #[test]
        fn numbers_of_few_decimals_are_written_in_full(units in -1_000_000_000i64..1_000_000_000, decimals in 0..=DECIMALS_MAX) {
            let value = units as f64 / f64::from(POWERS_OF_TEN[decimals]);
            prop_assert_eq!(Shortest(value).to_string(), format!("{value}"));
        }
    }
}

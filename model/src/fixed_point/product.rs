//! Products of typed fixed-point numbers: the compiler counts the binary places.
//!
//! A product of two 32-bit numbers is exact in 64 bits and has the binary places of both. The functions here
//! shift it to the places of the requested type, so that no shift is counted by hand. They compile to
//! one long multiplication and a shift. For a sum of products use [`fixed::FixedI32::wide_mul`], whose type
//! holds the places, and [`saturated`].

use fixed::types::extra::{LeEqU32, LeEqU64};
use fixed::{FixedI32, FixedI64, FixedU32};

/// A fixed-point number of 32 bits, signed or not.
pub trait Word: Copy {
    /// Binary places.
    const PLACES: u32;
    /// The number in units of its resolution.
    fn units(self) -> i64;
    /// Keeps the low 32 bits.
    fn wrapped(units: i64) -> Self;
    /// Limits to the range of the type.
    fn limited(units: i64) -> Self;
    /// As [`to_fixed`].
    fn rounded(value: f64) -> Self;
}

macro_rules! word {
    ($fixed:ident, $bits:ident, $rounded:ident) => {
        impl<Frac: LeEqU32> Word for $fixed<Frac> {
            const PLACES: u32 = Self::FRAC_NBITS;
            #[inline]
            fn units(self) -> i64 {
                self.to_bits().into()
            }
            #[inline]
            fn wrapped(units: i64) -> Self {
                Self::from_bits(units as $bits)
            }
            #[inline]
            fn limited(units: i64) -> Self {
                // Compares high words: half the instructions of a clamp after a shift.
                let high_word = |number: i64| (number >> 32) as i32;
                let low = units as $bits;
                Self::from_bits(if high_word(units) == high_word(low.into()) {
                    low
                } else if units < 0 {
                    <$bits>::MIN
                } else {
                    <$bits>::MAX
                })
            }
            #[inline]
            fn rounded(value: f64) -> Self {
                Self::from_bits($rounded(value, Self::PLACES))
            }
        }

        /// `value` in units of `2^-places`, rounded and limited. Not inlined, because set-up calls it a hundred times.
        #[inline(never)]
        fn $rounded(value: f64, places: u32) -> $bits {
            let units = rounded_units(value, places);
            units.clamp($bits::MIN.into(), $bits::MAX.into()) as $bits
        }
    };
}
word!(FixedI32, i32, rounded_i32);
word!(FixedU32, u32, rounded_u32);

/// `a b` in units of the resolution of `Out`, rounded down; exact before the shift, as one factor is signed.
#[inline]
fn shifted<Out: Word, Frac: LeEqU32, B: Word>(a: FixedI32<Frac>, b: B) -> i64 {
    const { assert!(FixedI32::<Frac>::FRAC_NBITS + B::PLACES >= Out::PLACES) };
    (a.units() * b.units()) >> (FixedI32::<Frac>::FRAC_NBITS + B::PLACES - Out::PLACES)
}

/// `a b`, rounded down (towards -∞). A product outside the range of `Out` wraps: for factors whose ranges
/// exclude it.
///
/// ```
/// use contact_model::fixed_point::{Celsius, Fraction, product};
/// let drop: Celsius = product(Celsius::lit("-10"), Fraction::lit("0.25"));
/// assert_eq!(drop, Celsius::lit("-2.5"));
/// ```
#[inline]
pub fn product<Out: Word, Frac: LeEqU32>(a: FixedI32<Frac>, b: impl Word) -> Out {
    Out::wrapped(shifted::<Out, _, _>(a, b))
}

/// `a b`, rounded down (towards -∞); saturates at the ends of `Out`.
#[inline]
pub fn saturating_product<Out: Word, Frac: LeEqU32>(a: FixedI32<Frac>, b: impl Word) -> Out {
    Out::limited(shifted::<Out, _, _>(a, b))
}

/// A 64-bit number, such as a sum of products, rounded down (towards -∞) to the places of `Out`; saturates at
/// the ends of `Out`. Half the instructions of [`fixed::FixedI64::saturating_to_num`], which gives the same.
#[inline]
pub fn saturated<Out: Word, Frac: LeEqU64>(wide: FixedI64<Frac>) -> Out {
    const { assert!(FixedI64::<Frac>::FRAC_NBITS >= Out::PLACES) };
    Out::limited(wide.to_bits() >> (FixedI64::<Frac>::FRAC_NBITS - Out::PLACES))
}

/// A constant for set-up, rounded to the nearest number that `Out` holds, halves away from zero; saturates at
/// the ends of `Out`. NaN gives 0.
pub fn to_fixed<Out: Word>(value: f64) -> Out {
    Out::rounded(value)
}

/// `value` in units of `2^-places`, rounded.
#[inline(never)]
pub fn rounded_units(value: f64, places: u32) -> i64 {
    libm::round(libm::ldexp(value, places as i32)) as i64
}

/// `value` in units of `2^-places`, of which there are at most 63, rounded towards 0 and limited to 32 bits. Not inlined, as above.
#[inline(never)]
pub const fn truncated_units(value: f64, places: u32) -> i32 {
    (value * (1u64 << places) as f64) as i32
}

/// The number with this number of units of `2^-places`. The conversions of `fixed`, which give the same, have 1.5 KB of code.
#[inline(never)]
pub fn units_to_f64(units: i64, places: u32) -> f64 {
    libm::ldexp(units as f64, -(places as i32))
}

#[cfg(test)]
mod tests {
    use fixed::types::{I1F31, I8F24, I10F22, U0F32, U16F16};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn products_have_the_bits_of_a_shift_counted_by_hand(a: i32, b: i32, c: u32) {
            let (celsius, part, fraction) =
                (I10F22::from_bits(a), I1F31::from_bits(b), U0F32::from_bits(c));
            let exact = i64::from(a) * i64::from(b);
            let wrapped: I8F24 = product(celsius, part);
            prop_assert_eq!(wrapped.to_bits(), (exact >> (22 + 31 - 24)) as i32);
            let limited: I8F24 = saturating_product(celsius, part);
            prop_assert_eq!(limited, I8F24::saturating_from_num(celsius.wide_mul(part)));
            let positive: U16F16 = saturating_product(celsius, part);
            prop_assert_eq!(positive, U16F16::saturating_from_num(celsius.wide_mul(part)));
            let share: I10F22 = product(celsius, fraction);
            prop_assert_eq!(share, I10F22::wrapping_from_num(celsius.wide_mul_unsigned(fraction)));
            let sum: I1F31 = saturated(celsius.wide_mul(part));
            prop_assert_eq!(sum, I1F31::saturating_from_num(celsius.wide_mul(part)));
        }
    }

    #[test]
    fn constants_round_to_the_nearest_and_saturate() {
        let units =
            |value: f64| to_fixed::<I10F22>(value * I10F22::DELTA.to_num::<f64>()).to_bits();
        assert_eq!([1.4, 1.5, -1.5, -1.4].map(units), [1, 2, -2, -1]);
        assert_eq!(to_fixed::<I10F22>(f64::NAN), I10F22::ZERO);
        assert_eq!([1e9, -1e9].map(to_fixed::<I10F22>), [I10F22::MAX, I10F22::MIN]);
        assert_eq!([1e9, -1e9].map(to_fixed::<U0F32>), [U0F32::MAX, U0F32::MIN]);
    }
}

//! Parsing of decimal numbers.

use fixed::types::I32F32;

/// Number of fractional bits while a fraction is read.
const FRACTION_BITS: u32 = 60;

/// Reads a decimal number such as `-12`, `.5` or `2.5e-3`, rounded to the nearest. A number beyond the range of [`I32F32`]
/// becomes its largest or smallest value, which lies outside of all ranges of arguments. `None` if the word is no number.
#[inline(never)]
pub fn fixed_point_from_decimal(word: &str) -> Option<I32F32> {
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (unsigned, 0),
    };
    let (whole, fraction) = mantissa.split_once(['.']).unwrap_or((mantissa, ""));
    let digits = whole.bytes().chain(fraction.bytes());
    let count = whole.len() + fraction.len();
    if count == 0 || digits.clone().any(|digit| !digit.is_ascii_digit()) {
        return None;
    }
    // Number of digits before the decimal point; below 0, zeros follow the point before the first digit.
    let point = exponent.saturating_add(whole.len() as i32);
    let split = count.min(point.max(0) as usize);
    let digits = digits.map(|digit| u64::from(digit - b'0'));

    let mut integer = 0u64;
    let append = |integer: u64, digit: u64| (integer * 10 + digit).min(1 << 32);
    for digit in digits.clone().take(split) {
        integer = append(integer, digit);
    }
    // Ten zeros after any other digit are beyond the range.
    for _ in 0..point.saturating_sub(count as i32).min(10) {
        integer = append(integer, 0);
    }

    // From the last digit to the first: each step cuts less than 2^-60 off and divides what was cut off before by ten.
    let mut bits = 0u64;
    for digit in digits.rev().take(count - split) {
        bits = (bits + (digit << FRACTION_BITS)) / 10;
    }
    for _ in 0..point.saturating_neg().min(FRACTION_BITS as i32) {
        bits /= 10;
    }
    let cut = FRACTION_BITS - I32F32::FRAC_NBITS;
    let fraction = (bits + (1 << (cut - 1))) >> cut;

    let magnitude = (u128::from(integer) << I32F32::FRAC_NBITS) + u128::from(fraction);
    let magnitude = I32F32::from_bits(i64::try_from(magnitude).unwrap_or(i64::MAX));
    Some(if word.starts_with('-') { -magnitude } else { magnitude })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::format;

    #[test]
    fn words_that_are_no_decimal_number_are_refused() {
        for word in [
            "",
            "+",
            "-",
            ".",
            "e5",
            "--1",
            "+-1",
            "1.2.3",
            "1-",
            "1e",
            "1e+",
            "1e1.5",
            "1e99999999999",
            "0x10",
            "1 ",
            "1,5",
            "\u{663}",
            "inf",
            "NaN",
        ] {
            assert_eq!(fixed_point_from_decimal(word), None, "{word}");
        }
    }

    #[test]
    fn numbers_beyond_the_range_saturate() {
        for (word, value) in [
            ("2147483648", I32F32::MAX),
            ("99999999999999999999999999999999999999999999", I32F32::MAX),
            ("-99999999999", -I32F32::MAX),
            ("1e2147483647", I32F32::MAX),
            ("1e-2147483648", I32F32::ZERO),
            ("0e2147483647", I32F32::ZERO),
            ("0.000000000000000000000000000000000000000000000001", I32F32::ZERO),
            ("2147483647.99999999999999999999", I32F32::MAX),
        ] {
            assert_eq!(fixed_point_from_decimal(word), Some(value), "{word}");
        }
    }

    proptest! {
        /// The parser of the crate `fixed` rounds exactly.
        #[test]
        fn numbers_are_read_as_by_another_parser(word in "[+-]?([0-9]{1,10}|[0-9]{0,8}[.][0-9]{1,25}|[0-9]{1,8}[.])([eE][+-]?[0-9]{1,2})?") {
            let expected = I32F32::saturating_from_str(&word).ok().map(|value| value.max(-I32F32::MAX));
            prop_assert_eq!(fixed_point_from_decimal(&word), expected, "{}", word);
        }

        #[test]
        fn a_number_with_all_its_digits_is_read_back(bits in any::<i64>()) {
            let value = I32F32::from_bits(bits).max(-I32F32::MAX);
            prop_assert_eq!(fixed_point_from_decimal(&format!("{value}")), Some(value));
            prop_assert_eq!(fixed_point_from_decimal(&format!("{value:.32}")), Some(value));
        }
    }
}

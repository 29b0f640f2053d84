//! Words of a line from the host, and numbers within a range.
//!
//! In this crate a text is split at `['x']`, not at `'x'`, whose search checks an index in code that is optimised for size.

use core::str::SplitAsciiWhitespace;

use contact_model::fixed_point::{rounded_units, units_to_f64};
use fixed::types::I32F32;
use thermal_settings::Range;

use crate::ReadError;
use crate::decimal_number::fixed_point_from_decimal;

/// Iterator over the words of a line from the host that are not read yet, separated by white space.
pub type Words<'a> = SplitAsciiWhitespace<'a>;

/// Returns the next word of a line.
///
/// # Errors
/// [`ReadError::Missing`] with `name`, the name of the argument that is expected: no word is left.
pub fn read_word<'a>(words: &mut Words<'a>, name: &'static str) -> Result<&'a str, ReadError> {
    words.next().ok_or(ReadError::Missing(name))
}

/// Returns the next word of a line, and an empty one if none is left, for arguments whose error names what is known.
pub fn word_or_empty<'a>(words: &mut Words<'a>) -> &'a str {
    words.next().unwrap_or_default()
}

/// Checks that no word is left on a line.
///
/// # Errors
/// [`ReadError::Extra`] with the word that follows.
pub fn expect_end(words: &mut Words<'_>) -> Result<(), ReadError> {
    words.next().map_or(Ok(()), |extra| Err(ReadError::Extra(extra.into())))
}

/// Skips the next word of a line if it is `expected`, and returns whether it is. Otherwise the word stays the next one.
pub fn skip_if_next_is(words: &mut Words<'_>, expected: &str) -> bool {
    let mut rest = words.clone();
    let is_next = rest.next() == Some(expected);
    if is_next {
        *words = rest;
    }
    is_next
}

/// Reads the next word of a line as a decimal number within `range`, both limits included.
///
/// # Errors
/// [`ReadError::NotANumber`]: the word is not a decimal number, or no word is left. [`ReadError::OutOfRange`]: the number lies
/// outside `range`.
pub fn read_fixed_point_in_range(
    words: &mut Words<'_>,
    range: &'static Range,
) -> Result<I32F32, ReadError> {
    let limit = |limit: f64| I32F32::from_bits(rounded_units(limit, I32F32::FRAC_NBITS));
    read_fixed_point_within(words, range, &[limit(range.min), limit(range.max)])
}

/// The same with the limits of the range as fixed-point numbers.
///
/// # Errors
/// Those of [`read_fixed_point_in_range`].
#[inline(never)]
pub fn read_fixed_point_within(
    words: &mut Words<'_>,
    range: &'static Range,
    [min, max]: &[I32F32; 2],
) -> Result<I32F32, ReadError> {
    let word = word_or_empty(words);
    let value = fixed_point_from_decimal(word).ok_or(ReadError::NotANumber(range, word.into()))?;
    if (min..=max).contains(&&value) {
        Ok(value)
    } else {
        Err(ReadError::OutOfRange(range, word.into()))
    }
}

/// The same as a float.
///
/// # Errors
/// Those of [`read_fixed_point_in_range`].
#[inline(never)]
pub fn read_number_in_range(
    words: &mut Words<'_>,
    range: &'static Range,
) -> Result<f64, ReadError> {
    let value = read_fixed_point_in_range(words, range)?;
    Ok(units_to_f64(value.to_bits(), I32F32::FRAC_NBITS))
}

/// Reads the next words of a line as decimal numbers, one for each of `ranges`, and returns them in this order. Each
/// number must lie within its range; the errors are those of [`read_fixed_point_in_range`].
pub fn read_numbers_in_ranges<const N: usize>(
    words: &mut Words<'_>,
    ranges: &'static [Range; N],
) -> Result<[f64; N], ReadError> {
    let mut values = [0.0; N];
    read_into(words, ranges, &mut values)?;
    Ok(values)
}

/// Not generic, so that the program contains this code only once.
#[inline(never)]
fn read_into(
    words: &mut Words<'_>,
    ranges: &'static [Range],
    values: &mut [f64],
) -> Result<(), ReadError> {
    for (value, range) in values.iter_mut().zip(ranges) {
        *value = read_number_in_range(words, range)?;
    }
    Ok(())
}

/// Reads the next word of a line as a whole number within `range`, both limits included. The errors are those of
/// [`read_fixed_point_in_range`]; a number that is not whole gives [`ReadError::OutOfRange`], too.
pub fn read_whole_number_in_range(
    words: &mut Words<'_>,
    range: &'static Range,
) -> Result<usize, ReadError> {
    let word = words.clone().next().unwrap_or_default();
    let value = read_fixed_point_in_range(words, range)?;
    if value.frac() == 0 {
        Ok((value.to_bits() >> I32F32::FRAC_NBITS) as usize)
    } else {
        Err(ReadError::OutOfRange(range, word.into()))
    }
}

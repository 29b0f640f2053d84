//! Arguments of a command on a line from the host: words, and numbers within a range.

use core::str::SplitAsciiWhitespace;

use fixed::types::I32F32;
use thermal_settings::Range;

use crate::Error;

/// Iterator over the words of a line from the host that are not read yet, separated by white space.
pub type Words<'a> = SplitAsciiWhitespace<'a>;

/// Reads the next word of a line. If there is none, the error is that the argument called `name` is missing.
pub fn read_word<'a>(words: &mut Words<'a>, name: &'static str) -> Result<&'a str, Error> {
    words.next().ok_or(Error::Missing(name))
}

/// Skips the next word of a line if it is `expected`, and returns whether it is.
pub fn skip_if_next_is(words: &mut Words<'_>, expected: &str) -> bool {
    let mut rest = words.clone();
    let is_next = rest.next() == Some(expected);
    if is_next {
        *words = rest;
    }
    is_next
}

/// Finds the entry of a table whose first element is `word`; `None` if there is none.
pub fn find_entry_by_word<T: Copy>(
    table: &[(&'static str, T)],
    word: &str,
) -> Option<(&'static str, T)> {
    table.iter().find(|(known, _)| *known == word).copied()
}

/// Reads the next word of a line as a decimal number, and checks that it lies within `range`, both limits included.
pub fn read_number(words: &mut Words<'_>, range: &'static Range) -> Result<I32F32, Error> {
    let word = read_word(words, range.name)?;
    // A number with too many digits becomes the largest `I32F32`, which is outside of all ranges.
    let value =
        I32F32::saturating_from_str(word).map_err(|_| Error::NotANumber(range, word.into()))?;
    if (I32F32::from_num(range.min)..=I32F32::from_num(range.max)).contains(&value) {
        Ok(value)
    } else {
        Err(Error::OutOfRange(range, word.into()))
    }
}

/// Reads the next words of a line as decimal numbers, one for each of `ranges`, and checks that each lies within its
/// range.
pub fn read_numbers<const N: usize>(
    words: &mut Words<'_>,
    ranges: &'static [Range; N],
) -> Result<[f64; N], Error> {
    let mut values = [0.0; N];
    for (value, range) in values.iter_mut().zip(ranges) {
        *value = read_number(words, range)?.to_num();
    }
    Ok(values)
}

/// Reads the next word of a line as a whole number, and checks that it lies within `range`, both limits included.
pub fn read_whole_number(words: &mut Words<'_>, range: &'static Range) -> Result<usize, Error> {
    let word = words.clone().next().unwrap_or_default();
    let value = read_number(words, range)?;
    if value.frac() == 0 {
        Ok(value.to_num())
    } else {
        Err(Error::OutOfRange(range, word.into()))
    }
}

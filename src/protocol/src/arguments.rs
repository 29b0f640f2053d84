//! Arguments of a command: words, and numbers within a range.

use core::str::SplitAsciiWhitespace;

use fixed::types::I32F32;
use thermal_settings::Range;

use crate::Error;

/// The words of a line that are not read yet.
pub type Words<'a> = SplitAsciiWhitespace<'a>;

/// Reads the next word; `name` is what is missing if there is none.
pub fn word<'a>(words: &mut Words<'a>, name: &'static str) -> Result<&'a str, Error> {
    words.next().ok_or(Error::Missing(name))
}

/// Skips the next word if it is the given one, and returns whether it is.
pub fn skip(words: &mut Words<'_>, expected: &str) -> bool {
    let mut rest = words.clone();
    let is_next = rest.next() == Some(expected);
    if is_next {
        *words = rest;
    }
    is_next
}

/// Finds the value of a word in a table of words and values.
pub fn lookup<T: Copy>(table: &[(&'static str, T)], word: &str) -> Option<(&'static str, T)> {
    table.iter().find(|(known, _)| *known == word).copied()
}

/// Reads the next word as a decimal number within its range.
pub fn number(words: &mut Words<'_>, range: &'static Range) -> Result<I32F32, Error> {
    let word = word(words, range.name)?;
    // A number with too many digits saturates, and is out of range then.
    let value =
        I32F32::saturating_from_str(word).map_err(|_| Error::NotANumber(range, word.into()))?;
    if (I32F32::from_num(range.min)..=I32F32::from_num(range.max)).contains(&value) {
        Ok(value)
    } else {
        Err(Error::OutOfRange(range, word.into()))
    }
}

/// Reads one decimal number for each range.
pub fn numbers<const N: usize>(
    words: &mut Words<'_>,
    ranges: &'static [Range; N],
) -> Result<[f64; N], Error> {
    let mut values = [0.0; N];
    for (value, range) in values.iter_mut().zip(ranges) {
        *value = number(words, range)?.to_num();
    }
    Ok(values)
}

/// Reads the next word as a whole number within its range.
pub fn whole_number(words: &mut Words<'_>, range: &'static Range) -> Result<usize, Error> {
    let word = words.clone().next().unwrap_or_default();
    let value = number(words, range)?;
    if value.frac() == 0 {
        Ok(value.to_num())
    } else {
        Err(Error::OutOfRange(range, word.into()))
    }
}

//! Why a line from the host is no request.

use core::fmt;

use contact_model::material::MATERIALS;
use thermal_settings::{Person, Range, WordList};

use crate::request::{command_words, second_words};

/// The first 20 bytes of a word from the host; `Display` writes them in single quotes, as part of an error message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuotedWordExcerpt(heapless::String<20>);

impl From<&str> for QuotedWordExcerpt {
    #[inline(never)]
    fn from(word: &str) -> Self {
        let mut excerpt = heapless::String::new();
        for c in word.chars() {
            if excerpt.push(c).is_err() {
                break;
            }
        }
        Self(excerpt)
    }
}

impl QuotedWordExcerpt {
    /// The excerpt without quotes.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether there is no word.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl fmt::Display for QuotedWordExcerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", self.0)
    }
}

/// Why a line from the host is no request; `Display` writes the message, which names what is allowed. A quoted word is empty if it
/// is missing.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// The first word of the line is no command.
    UnknownCommand(QuotedWordExcerpt),
    /// The word after this command is none that may stand there.
    UnknownSecondWord(&'static str, QuotedWordExcerpt),
    /// The word is none of this list.
    UnknownWord(&'static WordList, QuotedWordExcerpt),
    /// The argument of `material` is neither the name of a material nor `custom`.
    UnknownMaterial(QuotedWordExcerpt),
    /// The line lacks the word with this name.
    Missing(&'static str),
    /// The word follows the last argument of the command, where the line should end.
    Extra(QuotedWordExcerpt),
    /// The word is not a decimal number, but stands where the argument with this name and range is expected.
    NotANumber(&'static Range, QuotedWordExcerpt),
    /// The same of the word after this command, where other words may stand, too.
    NotANumberOrWord(&'static Range, &'static str, QuotedWordExcerpt),
    /// The number is outside the range of its argument, or is not whole where only a whole number is allowed.
    OutOfRange(&'static Range, QuotedWordExcerpt),
    /// The word stands where the code of a person is expected, but is none.
    NotPersonCode(QuotedWordExcerpt),
    /// The word stands where what was learnt of a finger is expected, but is not that.
    NotPersonData(QuotedWordExcerpt),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownCommand(word) => {
                write_unknown_word(f, "command", word)?;
                write_words(f, command_words())
            }
            Self::UnknownSecondWord(command, word) => {
                write_unknown_word(f, command, word)?;
                write_words(f, second_words(command))
            }
            Self::UnknownWord(list, word) => {
                write_unknown_word(f, list.kind, word)?;
                write_words(f, list.words.iter().copied())
            }
            Self::UnknownMaterial(word) => {
                write_unknown_word(f, "material", word)?;
                let names = MATERIALS.iter().map(|(name, _)| *name);
                write_words(f, names.chain(second_words("material")))
            }
            Self::Missing(argument) => write!(f, "{argument} missing"),
            Self::Extra(word) => write!(f, "unexpected {word} after the command"),
            Self::NotANumber(range, word) => write_not_a_number(f, range, word),
            Self::NotANumberOrWord(range, command, word) => {
                write_not_a_number(f, range, word)?;
                f.write_str("; or")?;
                write_words(f, second_words(command))
            }
            Self::OutOfRange(range, word) => {
                write!(f, "{} {word} out of range; {range}", range.name)
            }
            Self::NotPersonCode(word) if word.is_empty() => {
                f.write_str("person missing; a code of 1 to 8 of A-Z, 0-9")
            }
            Self::NotPersonCode(word) => {
                write!(f, "person {word}: a code is 1 to 8 of A-Z, 0-9")
            }
            Self::NotPersonData(word) => {
                write!(f, "data {word} is not {} hexadecimal digits", 2 * Person::FINGER_BYTES)
            }
        }
    }
}

/// Writes that a word is unknown, as in `unknown mode 'x'; known:`, or missing, as in `mode missing; known:`.
#[inline(never)]
fn write_unknown_word(
    f: &mut fmt::Formatter<'_>,
    kind: &str,
    word: &QuotedWordExcerpt,
) -> fmt::Result {
    if word.is_empty() {
        write!(f, "{kind} missing; known:")
    } else {
        write!(f, "unknown {kind} {word}; known:")
    }
}

fn write_words<'a>(
    f: &mut fmt::Formatter<'_>,
    mut words: impl Iterator<Item = &'a str>,
) -> fmt::Result {
    words.try_for_each(|word| {
        f.write_str(" ")?;
        f.write_str(word)
    })
}

#[inline(never)]
fn write_not_a_number(
    f: &mut fmt::Formatter<'_>,
    range: &Range,
    word: &QuotedWordExcerpt,
) -> fmt::Result {
    if word.is_empty() {
        write!(f, "{} missing; {range}", range.name)
    } else {
        write!(f, "{} {word} is not a decimal number; {range}", range.name)
    }
}

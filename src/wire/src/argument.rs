//! Arguments of requests.

use core::fmt;

use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_device::safety::ThermistorId;
use thermal_device::stimulus::{CourseEnd, CourseStart, TemperatureKind};
use thermal_settings::{Person, PersonCode, Vocabulary as _, vocabulary};

use crate::ReadError;
#[cfg(feature = "host")]
use crate::host::ArgumentForm;
use crate::words::{Words, word_or_empty};

/// What stands after the words of a request.
pub trait Argument: Sized {
    /// Reads it from the front of the words that are left.
    ///
    /// # Errors
    /// It is missing, unknown, no number, or out of range.
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError>;

    /// What stands there, for tables.
    #[cfg(feature = "host")]
    fn form() -> ArgumentForm;

    /// Writes a space and the argument.
    ///
    /// # Errors
    /// Those of the formatter.
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result;
}

/// Words of which one is the argument.
macro_rules! vocabularies {
    ($($vocabulary:ty),+ $(,)?) => {$(
        impl Argument for $vocabulary {
            fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
                let word = word_or_empty(words);
                let unknown = || ReadError::UnknownWord(Self::WORDS, word.into());
                Self::of_word(word).ok_or_else(unknown)
            }

            #[cfg(feature = "host")]
            fn form() -> ArgumentForm {
                ArgumentForm::Words(Self::WORDS.words)
            }

            fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(" ")?;
                f.write_str(self.name())
            }
        }
    )+};
}

vocabularies!(
    AssumedFinger,
    ContactModel,
    CourseEnd,
    CourseStart,
    Law,
    Switch,
    TemperatureKind,
    ThermistorId
);

vocabulary! {
    /// Whether something is to happen.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Switch: "switch" {
        /// It is.
        On = "on",
        /// It is not.
        Off = "off",
    }
}

impl Switch {
    /// Whether it is on.
    pub const fn is_on(self) -> bool {
        matches!(self, Self::On)
    }
}

impl From<bool> for Switch {
    fn from(is_on: bool) -> Self {
        if is_on { Self::On } else { Self::Off }
    }
}

/// An argument that may be left out.
impl<A: Argument> Argument for Option<A> {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        match words.clone().next() {
            None => Ok(None),
            Some(_) => A::read(words).map(Some),
        }
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Optional(std::boxed::Box::new(A::form()))
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_ref().map_or(Ok(()), |argument| argument.write(f))
    }
}

impl Argument for PersonCode {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let word = word_or_empty(words);
        Self::new(word).ok_or(ReadError::NotPersonCode(word.into()))
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("1 to 8 of A-Z, 0-9")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " {self}")
    }
}

/// What was learnt of a person's finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonData(pub [u8; Person::FINGER_BYTES]);

impl Argument for PersonData {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let word = word_or_empty(words);
        Person::read_finger(word).map(Self).ok_or(ReadError::NotPersonData(word.into()))
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("40 hexadecimal digits")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " {self}")
    }
}

/// Writes two hexadecimal digits for each byte.
impl fmt::Display for PersonData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| crate::TwoHexDigits(*byte).fmt(f))
    }
}

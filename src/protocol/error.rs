//! Why a line was refused.

use core::fmt;

use contact_model::fixed_point::PairingError;
use contact_model::material::MATERIALS;

use super::{Command, LINE_MAX, LineError};
use crate::control::Law;
use crate::guard::Fault;

/// The beginning of a word from the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word(heapless::String<20>);

impl From<&str> for Word {
    fn from(word: &str) -> Self {
        let mut kept = heapless::String::new();
        for c in word.chars() {
            if kept.push(c).is_err() {
                break;
            }
        }
        Self(kept)
    }
}

/// A number that a command takes.
#[derive(Debug, PartialEq)]
pub struct Number {
    /// What it is.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
}

/// Why a line was refused; `Display` writes the answer without its end, at most 128 bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The bytes made no line.
    Line(LineError),
    /// First word unknown.
    UnknownCommand(Word),
    /// No such finger; there are that many.
    UnknownFinger(Word, usize),
    /// Material unknown.
    UnknownMaterial(Word),
    /// Mode unknown.
    UnknownMode(Word),
    /// Law unknown.
    UnknownLaw(Word),
    /// A word is missing.
    Missing(&'static str),
    /// A word too many.
    Extra(Word),
    /// A word that should be a decimal number.
    NotANumber(&'static Number, Word),
    /// A number outside of its range.
    OutOfRange(&'static Number, Word),
    /// A custom material that cannot be rendered.
    Pairing(PairingError),
    /// `start` before `arm`.
    NotArmed,
    /// `start` before `material`.
    NoMaterial,
    /// `start` twice.
    AlreadyStarted,
    /// A fault is latched.
    Tripped(Fault),
    /// `clear` while the fault is still there.
    StillFaulty(Fault),
    /// `clear` without a fault.
    NothingToClear,
}

impl From<LineError> for Error {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", self.0)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("err ")?;
        match self {
            Self::Line(LineError::TooLong) => write!(f, "line too long; at most {LINE_MAX} bytes"),
            Self::Line(LineError::NotText(byte)) => write!(f, "byte 0x{byte:02x} is not printable ASCII"),
            Self::Line(LineError::Reception) => {
                f.write_str("a byte was damaged or lost; send the line again")
            }
            Self::Line(LineError::Refused) => f.write_str("busy; wait for the answer before the next line"),
            Self::UnknownCommand(word) => {
                write!(f, "unknown command {word}; known:")?;
                Command::WORDS.iter().try_for_each(|known| write!(f, " {known}"))
            }
            Self::UnknownFinger(word, fingers) => {
                write!(
                    f,
                    "unknown finger {word} after @; known: 0 to {}",
                    fingers.saturating_sub(1)
                )
            }
            Self::UnknownMaterial(word) => {
                write!(f, "unknown material {word}; known:")?;
                MATERIALS
                    .iter()
                    .try_for_each(|(known, _)| write!(f, " {known}"))?;
                f.write_str(" custom")
            }
            Self::UnknownMode(word) => write!(f, "unknown mode {word}; known: contact semi-infinite"),
            Self::UnknownLaw(word) => {
                write!(f, "unknown law {word}; known:")?;
                Law::WORDS.iter().try_for_each(|(known, _)| write!(f, " {known}"))
            }
            Self::Missing(what) => write!(f, "{what} missing"),
            Self::Extra(word) => write!(f, "unexpected {word} after the command"),
            Self::NotANumber(Number { name, unit, min, max }, word) => {
                write!(f, "{name} {word} is not a decimal number; {min} to {max} {unit}")
            }
            Self::OutOfRange(Number { name, unit, min, max }, word) => {
                write!(f, "{name} {word} out of range; {min} to {max} {unit}")
            }
            Self::Pairing(error) => write!(f, "{error}"),
            Self::NotArmed => f.write_str("start needs arm first"),
            Self::NoMaterial => f.write_str("start needs a material first"),
            Self::AlreadyStarted => f.write_str("already started; arm takes the object away"),
            Self::Tripped(fault) => write!(f, "tripped by {}; clear it first", fault.name()),
            Self::StillFaulty(fault) => write!(f, "fault {} is still present", fault.name()),
            Self::NothingToClear => f.write_str("no fault to clear"),
        }
    }
}

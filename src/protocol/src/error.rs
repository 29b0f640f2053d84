//! Error messages: why a line was rejected.

use core::fmt;

use contact_model::fixed_point::ContactPairError;
use contact_model::material::MATERIALS;

use thermal_commissioning::{
    IdentificationError, POINT_DEVIATION_MAX_K, POINTS_MAX, PointError, SENSOR_WORDS, SessionError,
};
use thermal_device::command::Refused;
use thermal_device::control::Law;
use thermal_settings::Range;

use crate::command::{CUSTOM, MODES};
use crate::commissioning_commands::SETTING_WORDS;
use crate::{LINE_MAX_BYTES, LineError, Request};

/// The first 20 bytes of a word from the host, to be quoted in an error message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordExcerpt(heapless::String<20>);

impl From<&str> for WordExcerpt {
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

impl fmt::Display for WordExcerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}'", self.0)
    }
}

/// The message of a hardware error, at most 56 bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailureText(heapless::String<56>);

impl FailureText {
    /// The beginning of an error's message.
    #[must_use]
    pub fn new(error: &impl fmt::Display) -> Self {
        let mut text = heapless::String::new();
        // A longer message is cut off.
        let _ = fmt::Write::write_fmt(&mut text, format_args!("{error}"));
        Self(text)
    }
}

/// Why a line was rejected; `Display` writes the answer without its line ending, at most
/// [`ANSWER_MAX_BYTES`](super::ANSWER_MAX_BYTES) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The received bytes form no line.
    Line(LineError),
    /// The first word is no command.
    UnknownCommand(WordExcerpt),
    /// The device has no such finger; the number is that of its fingers.
    UnknownFinger(WordExcerpt, usize),
    /// The word is no material.
    UnknownMaterial(WordExcerpt),
    /// The word is no mode.
    UnknownMode(WordExcerpt),
    /// The word is no control law.
    UnknownLaw(WordExcerpt),
    /// The word is no thermistor.
    UnknownSensor(WordExcerpt),
    /// The word is no setting.
    UnknownSetting(WordExcerpt),
    /// The named argument is missing.
    Missing(&'static str),
    /// A word follows the last argument.
    Extra(WordExcerpt),
    /// The word is not a decimal number.
    NotANumber(&'static Range, WordExcerpt),
    /// The number is outside its range.
    OutOfRange(&'static Range, WordExcerpt),
    /// The contact with a custom material is outside the domain of the contact model.
    ContactPair(ContactPairError),
    /// The named command needs all bridges off.
    NeedsOff(&'static str),
    /// The named command cannot address a single finger.
    WholeDevice(&'static str),
    /// The settings could not be stored.
    NotStored(FailureText),
    /// The station refuses the command.
    Refused(Refused),
    /// The recorded response is not that of a tile.
    Identification(IdentificationError),
    /// The calibration point is rejected.
    Point(PointError),
}

impl From<Refused> for Error {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

impl From<SessionError> for Error {
    fn from(error: SessionError) -> Self {
        match error {
            SessionError::Refused(refused) => Self::Refused(refused),
            SessionError::Identification(error) => Self::Identification(error),
            SessionError::Point(error) => Self::Point(error),
        }
    }
}

impl From<LineError> for Error {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("err ")?;
        match self {
            Self::Line(error) => line(f, *error),
            Self::UnknownCommand(word) => {
                write_unknown_word(f, "command", word, Request::WORDS.iter().copied())
            }
            Self::UnknownFinger(word, fingers) => {
                let last = fingers.saturating_sub(1);
                write!(f, "unknown finger {word} after @; known: 0 to {last}")
            }
            Self::UnknownMaterial(word) => {
                let names = MATERIALS.iter().map(|(name, _)| *name);
                write_unknown_word(f, "material", word, names.chain([CUSTOM]))
            }
            Self::UnknownMode(word) => {
                write_unknown_word(f, "mode", word, MODES.iter().map(|(name, _)| *name))
            }
            Self::UnknownLaw(word) => write_unknown_word(
                f,
                "law",
                word,
                Law::PROTOCOL_WORDS.iter().map(|(name, _)| *name),
            ),
            Self::UnknownSensor(word) => {
                write_unknown_word(f, "sensor", word, SENSOR_WORDS.iter().copied())
            }
            Self::UnknownSetting(word) => {
                write_unknown_word(f, "setting", word, SETTING_WORDS.iter().copied())
            }
            Self::Missing(argument) => write!(f, "{argument} missing"),
            Self::Extra(word) => write!(f, "unexpected {word} after the command"),
            Self::NotANumber(range, word) => {
                write!(f, "{} {word} is not a decimal number; {range}", range.name)
            }
            Self::OutOfRange(range, word) => {
                write!(f, "{} {word} out of range; {range}", range.name)
            }
            Self::ContactPair(error) => error.fmt(f),
            Self::NeedsOff(command) => write!(f, "{command} needs the bridge off: abort first"),
            Self::WholeDevice(command) => write!(f, "{command} is for all fingers at once"),
            Self::NotStored(FailureText(failure)) => write!(f, "not stored: {failure}"),
            Self::Refused(refused) => refusal(f, refused),
            Self::Identification(error) => identification(f, error),
            Self::Point(error) => point(f, error),
        }
    }
}

/// Writes that a word is unknown, and the known words.
fn write_unknown_word<'a>(
    f: &mut fmt::Formatter<'_>,
    kind: &str,
    word: &WordExcerpt,
    known: impl Iterator<Item = &'a str>,
) -> fmt::Result {
    write_unknown_prefix(f, kind, word)?;
    for known in known {
        f.write_str(" ")?;
        f.write_str(known)?;
    }
    Ok(())
}

/// The part of [`write_unknown_word`] that does not depend on the iterator, so that the image contains it once.
#[inline(never)]
fn write_unknown_prefix(f: &mut fmt::Formatter<'_>, kind: &str, word: &WordExcerpt) -> fmt::Result {
    write!(f, "unknown {kind} {word}; known:")
}

fn line(f: &mut fmt::Formatter<'_>, error: LineError) -> fmt::Result {
    match error {
        LineError::TooLong => write!(f, "line too long; at most {LINE_MAX_BYTES} bytes"),
        LineError::NotText(byte) => write!(f, "byte 0x{byte:02x} is not printable ASCII"),
        LineError::Reception => f.write_str("a byte was damaged or lost; send the line again"),
        LineError::QueueFull => f.write_str("busy; wait for the answer before the next line"),
    }
}

fn refusal(f: &mut fmt::Formatter<'_>, refused: &Refused) -> fmt::Result {
    f.write_str(match refused {
        Refused::NotArmed => "start needs arm first",
        Refused::Testing => "the self-test goes on; ask again in a second",
        Refused::NoMaterial => "start needs a material first",
        Refused::AlreadyStarted => "already started; arm takes the object away",
        Refused::NeedsArmed(command) => return write!(f, "{command} needs the state armed"),
        Refused::Presenting => "not while an object is presented: abort or arm first",
        Refused::Touched => "tune needs a display without a finger on it",
        Refused::NotTuned => "nothing was tuned since arm; tune first",
        Refused::Tuning => "tuning goes on; ask again in a second",
        Refused::TuneAborted(why) => return write!(f, "tune was ended: {}", why.description()),
        Refused::TooEarly => "not watched for long enough; wait half a second",
        Refused::Tripped(fault) => {
            return write!(f, "tripped by {}; clear it first", fault.name());
        }
        Refused::StillFaulty(fault) => {
            return write!(f, "fault {} is still present", fault.name());
        }
        Refused::NothingToClear => "no fault to clear",
    })
}

fn identification(f: &mut fmt::Formatter<'_>, error: &IdentificationError) -> fmt::Result {
    match error {
        IdentificationError::CurrentRatio(ratio) => write!(
            f,
            "tune measured {ratio:.2} of the current asked for; look at bridge, module and current mirror"
        ),
        IdentificationError::NoResponse => {
            f.write_str("tune saw no answer of the display to the current; look at its thermistor")
        }
        IdentificationError::ModelMismatch(residual) => write!(
            f,
            "tune saw {:.2} % of what the display did come from elsewhere; look for a loose sensor, a draught, a touch",
            100.0 * residual
        ),
        IdentificationError::OutOfRange(
            Range {
                name,
                unit,
                min,
                max,
            },
            value,
        ) => write!(
            f,
            "tune found a {name} of {value:.3} {unit}; {min} to {max} is a tile; look at sensor and polarity"
        ),
    }
}

fn point(f: &mut fmt::Formatter<'_>, error: &PointError) -> fmt::Result {
    match error {
        PointError::Unsteady => f.write_str(
            "the reading moves; wait until it is steady to 3 mK in a quarter of a second",
        ),
        PointError::AtBorder => {
            f.write_str("at a step of the converter; take a temperature 0.3 C from here")
        }
        PointError::TooFar(reading) => write!(
            f,
            "the device reads {reading:.2} C; allowed is within {POINT_DEVIATION_MAX_K} C of that"
        ),
        PointError::Contradicts => {
            f.write_str("no correction fits this and the points before; clear them and begin again")
        }
        PointError::Full => write!(f, "no room for more than {POINTS_MAX} points; clear them"),
    }
}

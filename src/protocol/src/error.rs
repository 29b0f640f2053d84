//! Why a line was refused.

use core::fmt;

use contact_model::fixed_point::ContactPairError;
use contact_model::material::MATERIALS;

use thermal_commissioning::{FARTHEST_K, NoTile, POINTS, PointError, SENSORS};
use thermal_device::command::Refused;
use thermal_device::control::Law;
use thermal_settings::Range;

use crate::{LINE_MAX, LineError, Parsed};

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

/// Why the hardware refused, in its own words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason(heapless::String<56>);

impl Reason {
    /// As it is displayed, cut to what a line holds.
    #[must_use]
    pub fn of(why: &impl fmt::Display) -> Self {
        let mut text = heapless::String::new();
        // The beginning of what does not fit says enough.
        let _ = fmt::Write::write_fmt(&mut text, format_args!("{why}"));
        Self(text)
    }
}

/// Why a line was refused; `Display` writes the answer without its end, at most
/// [`ANSWER_MAX`](super::ANSWER_MAX) bytes.
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
    /// Thermistor unknown.
    UnknownSensor(Word),
    /// Setting unknown.
    UnknownSetting(Word),
    /// A word is missing.
    Missing(&'static str),
    /// A word too many.
    Extra(Word),
    /// A word that should be a decimal number.
    NotANumber(&'static Range, Word),
    /// A number outside of its range.
    OutOfRange(&'static Range, Word),
    /// A custom material that cannot be rendered.
    ContactPair(ContactPairError),
    /// Settings are stored only while the bridge is off.
    NeedsOff(&'static str),
    /// A command that no single finger can be given.
    WholeDevice(&'static str),
    /// Settings could not be stored.
    NotStored(Reason),
    /// The station refuses.
    Refused(Refused),
    /// The identification's sums belong to no tile within the limits of settings.
    NoTile(NoTile),
    /// A point of a calibration is not taken.
    Point(PointError),
}

impl From<Refused> for Error {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

impl From<thermal_commissioning::Error> for Error {
    fn from(error: thermal_commissioning::Error) -> Self {
        match error {
            thermal_commissioning::Error::Refused(refused) => Self::Refused(refused),
            thermal_commissioning::Error::NoTile(no_tile) => Self::NoTile(no_tile),
            thermal_commissioning::Error::Point(point) => Self::Point(point),
        }
    }
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
            Self::Line(LineError::NotText(byte)) => {
                write!(f, "byte 0x{byte:02x} is not printable ASCII")
            }
            Self::Line(LineError::Reception) => {
                f.write_str("a byte was damaged or lost; send the line again")
            }
            Self::Line(LineError::Refused) => {
                f.write_str("busy; wait for the answer before the next line")
            }
            Self::UnknownCommand(word) => {
                write!(f, "unknown command {word}; known:")?;
                Parsed::WORDS
                    .iter()
                    .try_for_each(|known| write!(f, " {known}"))
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
            Self::UnknownMode(word) => {
                write!(f, "unknown mode {word}; known: contact semi-infinite")
            }
            Self::UnknownLaw(word) => {
                write!(f, "unknown law {word}; known:")?;
                Law::WORDS
                    .iter()
                    .try_for_each(|(known, _)| write!(f, " {known}"))
            }
            Self::UnknownSensor(word) => {
                write!(f, "unknown sensor {word}; known:")?;
                SENSORS.iter().try_for_each(|known| write!(f, " {known}"))
            }
            Self::UnknownSetting(word) => {
                write!(f, "unknown setting {word}; known: steps correction tile")
            }
            Self::Missing(what) => write!(f, "{what} missing"),
            Self::Extra(word) => write!(f, "unexpected {word} after the command"),
            Self::NotANumber(
                Range {
                    name,
                    unit,
                    min,
                    max,
                },
                word,
            ) => {
                write!(
                    f,
                    "{name} {word} is not a decimal number; {min} to {max} {unit}"
                )
            }
            Self::OutOfRange(
                Range {
                    name,
                    unit,
                    min,
                    max,
                },
                word,
            ) => {
                write!(f, "{name} {word} out of range; {min} to {max} {unit}")
            }
            Self::ContactPair(error) => write!(f, "{error}"),
            Self::Refused(Refused::NotArmed) => f.write_str("start needs arm first"),
            Self::Refused(Refused::Testing) => {
                f.write_str("the self-test goes on; ask again in a second")
            }
            Self::Refused(Refused::NoMaterial) => f.write_str("start needs a material first"),
            Self::Refused(Refused::AlreadyStarted) => {
                f.write_str("already started; arm takes the object away")
            }
            Self::Refused(Refused::NeedsArmed(command)) => {
                write!(f, "{command} needs the state armed")
            }
            Self::NeedsOff(command) => write!(f, "{command} needs the bridge off: abort first"),
            Self::WholeDevice(command) => write!(f, "{command} is for all fingers at once"),
            Self::NotStored(Reason(why)) => write!(f, "not stored: {why}"),
            Self::Refused(Refused::Presenting) => {
                f.write_str("not while an object is presented: abort or arm first")
            }
            Self::Refused(Refused::Touched) => {
                f.write_str("tune needs a display without a finger on it")
            }
            Self::Refused(Refused::NotTuned) => {
                f.write_str("nothing was tuned since arm; tune first")
            }
            Self::Refused(Refused::Tuning) => f.write_str("tuning goes on; ask again in a second"),
            Self::Refused(Refused::TuneAborted(why)) => {
                write!(f, "tune was ended: {}", why.reason())
            }
            Self::NoTile(NoTile::Current(part)) => write!(
                f,
                "tune measured {part:.2} of the current asked for; look at bridge, module and current mirror"
            ),
            Self::NoTile(NoTile::Nothing) => f.write_str(
                "tune saw no answer of the display to the current; look at its thermistor",
            ),
            Self::NoTile(NoTile::Unlike(part)) => write!(
                f,
                "tune saw {:.2} % of what the display did come from elsewhere; look for a loose sensor, a draught, a touch",
                100.0 * part
            ),
            Self::NoTile(NoTile::Beyond(
                Range {
                    name,
                    unit,
                    min,
                    max,
                },
                value,
            )) => write!(
                f,
                "tune found a {name} of {value:.3} {unit}; {min} to {max} is a tile; look at sensor and polarity"
            ),
            Self::Refused(Refused::TooEarly) => {
                f.write_str("not watched for long enough; wait half a second")
            }
            Self::Point(PointError::Unsteady) => f.write_str(
                "the reading moves; wait until it is steady to 3 mK in a quarter of a second",
            ),
            Self::Point(PointError::AtBorder) => {
                f.write_str("at a step of the converter; take a temperature 0.3 C from here")
            }
            Self::Point(PointError::TooFar(reads)) => {
                write!(
                    f,
                    "the device reads {reads:.2} C; allowed is within {FARTHEST_K} C of that"
                )
            }
            Self::Point(PointError::Contradicts) => f.write_str(
                "no correction fits this and the points before; clear them and begin again",
            ),
            Self::Point(PointError::Full) => {
                write!(f, "no room for more than {POINTS} points; clear them")
            }
            Self::Refused(Refused::Tripped(fault)) => {
                write!(f, "tripped by {}; clear it first", fault.name())
            }
            Self::Refused(Refused::StillFaulty(fault)) => {
                write!(f, "fault {} is still present", fault.name())
            }
            Self::Refused(Refused::NothingToClear) => f.write_str("no fault to clear"),
        }
    }
}

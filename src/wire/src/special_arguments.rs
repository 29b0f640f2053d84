//! Arguments of a form of their own.

use core::fmt;

use contact_model::material::{MATERIALS, Material};
use contact_model::slab::Back;
use thermal_device::TelemetryFields;
use thermal_device::events::{DeviceEventKind, EventKinds};
use thermal_device::stimulus::{CourseEnd, CourseStart, PlayOrder};
use thermal_settings::{Vocabulary as _, WordList};

use crate::argument::Argument;
#[cfg(feature = "host")]
use crate::host::ArgumentForm;
use crate::number::{Number, Quantity as _};
use crate::quantity::{Film, Reference, Repeats, Thickness};
use crate::telemetry::{self, DEFAULT_FIELDS, NO_FIELDS};
use crate::words::{Words, read_whole_number_in_range, skip_if_next_is, word_or_empty};
use crate::{QuotedWordExcerpt, ReadError};

/// Name of a material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialName(QuotedWordExcerpt);

impl MaterialName {
    /// The material of [`MATERIALS`] with this name, and its name there.
    ///
    /// # Errors
    /// There is none.
    pub fn find(&self) -> Result<(&'static str, &'static Material), ReadError> {
        let known = MATERIALS.iter().find(|(name, _)| *name == self.0.as_str());
        let (name, properties) = known.ok_or_else(|| ReadError::UnknownMaterial(self.0.clone()))?;
        Ok((name, properties))
    }
}

impl From<&str> for MaterialName {
    fn from(name: &str) -> Self {
        Self(name.into())
    }
}

impl Argument for MaterialName {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let name = Self::from(word_or_empty(words));
        name.find().map(|_| name)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("name of a material")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " {}", self.0.as_str())
    }
}

/// Fields of telemetry by their names; the default ones if there is none.
impl Argument for TelemetryFields {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        const FIELDS: &WordList = &WordList { kind: "field", words: &telemetry::NAMES };
        let mut fields = NO_FIELDS;
        for word in words {
            let place = telemetry::place_of_field(word);
            let place = place.ok_or_else(|| ReadError::UnknownWord(FIELDS, word.into()))?;
            fields = fields.with(place);
        }
        Ok(telemetry::chosen_or_default(fields))
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Optional(std::boxed::Box::new(ArgumentForm::List(&telemetry::NAMES, " ")))
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == DEFAULT_FIELDS {
            return Ok(());
        }
        let names = telemetry::NAMES.iter().enumerate();
        let mut chosen = names.filter(|(place, _)| self.contains(*place));
        chosen.try_for_each(|(_, name)| write!(f, " {name}"))
    }
}

/// Argument of `trigger-out` that switches the output off.
const NO_EVENTS_WORD: &str = "none";
const MARKED: &WordList =
    &WordList { kind: "event", words: &["land", "lift", "start", "end", "flux", NO_EVENTS_WORD] };

/// `none`, or kinds of events that are joined by commas. An edge at the trigger input is none of them.
impl Argument for EventKinds {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let list = word_or_empty(words);
        let mut kinds = Self::NONE;
        if list == NO_EVENTS_WORD {
            return Ok(kinds);
        }
        for word in list.split([',']) {
            match DeviceEventKind::of_word(word) {
                Some(kind) if kind != DeviceEventKind::Trigger => kinds = kinds.with(kind),
                _ => return Err(ReadError::UnknownWord(MARKED, word.into())),
            }
        }
        Ok(kinds)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::List(MARKED.words, ",")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let chosen = DeviceEventKind::ALL.iter().filter(|kind| self.contains(**kind));
        let mut separator = " ";
        for kind in chosen {
            write!(f, "{separator}{}", kind.name())?;
            separator = ",";
        }
        if *self == Self::NONE { write!(f, " {NO_EVENTS_WORD}") } else { Ok(()) }
    }
}

/// Thickness of a slab. The unit may follow, as in `3mm` or `3 mm`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Millimetres(pub Number<Thickness>);

impl Argument for Millimetres {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let word = word_or_empty(words);
        let number = word.strip_suffix("mm").unwrap_or(word);
        let read = Number::read(&mut number.split_ascii_whitespace());
        let thickness = read.map_err(|error| match error {
            ReadError::NotANumber(range, _) => ReadError::NotANumber(range, word.into()),
            error => error,
        })?;
        if number == word {
            skip_if_next_is(words, "mm");
        }
        Ok(Self(thickness))
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Number(Thickness::RANGE)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.write(f)?;
        f.write_str("mm")
    }
}

const BACKS: &WordList = &WordList { kind: "back", words: &["insulated", "held", "film"] };

/// What is behind a slab: `insulated`, `held`, or `film` with its coefficient.
impl Argument for Back {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        Ok(match word_or_empty(words) {
            "insulated" => Self::Insulated,
            "held" => Self::Held,
            "film" => Self::Film(Number::<Film>::read(words)?.f64()),
            unknown => return Err(ReadError::UnknownWord(BACKS, unknown.into())),
        })
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("insulated, held, or film with 0.1 to 100000 W/m2K")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Insulated => f.write_str(" insulated"),
            Self::Held => f.write_str(" held"),
            Self::Film(film_w_m2k) => write!(f, " film {film_w_m2k}"),
        }
    }
}

/// What starts a course, how often it is repeated, and what follows; the last two may be left out.
impl Argument for PlayOrder {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        let start = CourseStart::read(words)?;
        let is_number = |word: &str| !word.starts_with(|first: char| first.is_ascii_alphabetic());
        let play_count = match words.clone().next() {
            Some(word) if is_number(word) => {
                read_whole_number_in_range(words, Repeats::RANGE)? as u16
            }
            _ => 1,
        };
        let end = Option::<CourseEnd>::read(words)?.unwrap_or_default();
        Ok(Self { start, play_count, end })
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("now, trigger or landing; repeats, 1 to 1000; hold or neutral")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " {} {} {}", self.start.name(), self.play_count, self.end.name())
    }
}

/// A calibration point, or none of them any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointOrClear {
    /// What the reference thermometer shows.
    Point(Number<Reference>),
    /// `clear`.
    Clear,
}

impl Argument for PointOrClear {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        if skip_if_next_is(words, "clear") {
            return Ok(Self::Clear);
        }
        Number::read(words).map(Self::Point)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Text("clear, or 0 to 60 C")
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point(reference_c) => reference_c.write(f),
            Self::Clear => f.write_str(" clear"),
        }
    }
}

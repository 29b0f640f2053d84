//! The arguments of `object`: temperature before contact, half-space, or slab with its back.

use contact_model::fixed_point::saturated;
use contact_model::slab::Back;
use thermal_device::command::{Command, ObjectBody};
use thermal_settings::Range;

use crate::arguments::{
    Words, read_fixed_point_in_range, read_number_in_range, skip_if_next_is, word_or_empty,
};
use crate::{Error, Request};

static OBJECT_TEMPERATURE_RANGE: Range =
    Range { name: "object temperature", unit: "C", min: -20.0, max: 60.0 };
static THICKNESS_RANGE: Range = Range { name: "thickness", unit: "mm", min: 0.1, max: 1000.0 };
static FILM_RANGE: Range = Range { name: "film", unit: "W/m2K", min: 0.1, max: 100_000.0 };
/// What may follow `object`, for the error message. Its range is that of [`OBJECT_TEMPERATURE_RANGE`].
pub const OBJECT_ARGUMENTS: &str = "slab, half-space, room, or -20 to 60 C";
/// Words for the back of a slab, which the answer to an unknown one lists.
pub const BACK_WORDS: [&str; 3] = ["insulated", "held", "film"];

/// Reads `CELSIUS`, `room`, `half-space`, or a slab such as `slab 3mm insulated`. The unit may be left out or follow after a
/// space; `held`, or `film` with its coefficient in W/(m² K), may stand in place of `insulated`.
///
/// # Errors
/// An argument is missing, unknown, no number, or out of range.
pub fn parse_object(words: &mut Words<'_>) -> Result<Request, Error> {
    let word = words.clone().next().unwrap_or_default();
    if skip_if_next_is(words, "room") {
        return Ok(Request::Station(Command::Object(None)));
    }
    if skip_if_next_is(words, "half-space") {
        return Ok(Request::Station(Command::Body(ObjectBody::HalfSpace)));
    }
    if !skip_if_next_is(words, "slab") {
        return match read_fixed_point_in_range(words, &OBJECT_TEMPERATURE_RANGE) {
            Ok(celsius) => Ok(Request::Station(Command::Object(Some(saturated(celsius))))),
            Err(Error::NotANumber(..)) => Err(Error::UnknownObject(word.into())),
            Err(error) => Err(error),
        };
    }
    let word = word_or_empty(words);
    let number = word.strip_suffix("mm").unwrap_or(word);
    let thickness_mm = read_number_in_range(&mut number.split_ascii_whitespace(), &THICKNESS_RANGE)
        .map_err(|error| match error {
            Error::NotANumber(range, _) => Error::NotMillimetres(range, word.into()),
            error => error,
        })?;
    if number == word {
        skip_if_next_is(words, "mm");
    }
    let back = match word_or_empty(words) {
        "insulated" => Back::Insulated,
        "held" => Back::Held,
        "film" => Back::Film(read_number_in_range(words, &FILM_RANGE)?),
        unknown => return Err(Error::UnknownBack(unknown.into())),
    };
    Ok(Request::Slab { thickness_mm, back })
}

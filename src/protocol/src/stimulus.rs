//! Arguments of the commands that prescribe temperatures: `hold`, `play`, `pulse`, `skin`, and the upload of a course.

use contact_model::fixed_point::{Celsius, saturated};
use fixed::types::I32F32;
use thermal_device::command::Command;
use thermal_device::safety::Setpoint;
use thermal_device::safety::limits::{SETPOINT_MAX_C, SETPOINT_MIN_C};
use thermal_device::stimulus::{
    COURSE_DURATION_MAX_MS, COURSE_POINTS_MAX, COURSE_RATE_MAX_K_S, Course, CourseEnd, CourseError,
    CoursePoint, CourseStart, Hold, PlayOrder, TemperatureKind,
};
use thermal_settings::Range;

use crate::Error;
use crate::arguments::{
    Words, read_fixed_point_in_range, read_whole_number_in_range, table_entry_for_word_or_none,
    word_or_empty,
};

static TEMPERATURE_RANGE: Range =
    Range { name: "temperature", unit: "C", min: SETPOINT_MIN_C, max: SETPOINT_MAX_C };
static SKIN_RANGE: Range =
    Range { name: "skin", unit: "C", min: SETPOINT_MIN_C, max: SETPOINT_MAX_C };
static RELATIVE_TEMPERATURE_RANGE: Range = Range {
    name: "temperature",
    unit: "K",
    min: SETPOINT_MIN_C - SETPOINT_MAX_C,
    max: SETPOINT_MAX_C - SETPOINT_MIN_C,
};
static RATE_RANGE: Range =
    Range { name: "rate", unit: "K/s", min: 0.01, max: COURSE_RATE_MAX_K_S as f64 };
static TIME_RANGE: Range =
    Range { name: "time", unit: "s", min: 0.0, max: COURSE_DURATION_MAX_MS as f64 / 1e3 };
static TIMES_RANGE: Range = Range { name: "repeats", unit: "", min: 1.0, max: 1000.0 };
/// Number of points of a course.
pub static COURSE_POINT_COUNT_RANGE: Range =
    Range { name: "number of points", unit: "", min: 2.0, max: COURSE_POINTS_MAX as f64 };
/// Index of a point of a course.
pub static COURSE_POINT_INDEX_RANGE: Range =
    Range { name: "row", unit: "", min: 0.0, max: (COURSE_POINTS_MAX - 1) as f64 };

/// The line `pulse BASE TARGET RISE_K_S HOLD_S RETURN_K_S`, and when its course is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulse {
    base: Celsius,
    target: Celsius,
    rise_k_s: Celsius,
    hold_ms: u32,
    return_k_s: Celsius,
    /// When and how often it is played.
    pub order: PlayOrder,
}

impl Pulse {
    /// Replaces a course by that of the pulse: from base to target, there until the hold ends, and back.
    ///
    /// # Errors
    /// The course is too long or too hot for too long.
    pub fn replace_course(&self, course: &mut Course) -> Result<(), CourseError> {
        course.clear(TemperatureKind::Absolute);
        let mut time_ms = 0u32;
        for (temperature, duration_ms) in [
            (self.base, 0),
            (self.target, duration_ms(self.base, self.target, self.rise_k_s)),
            (self.target, self.hold_ms),
            (self.base, duration_ms(self.base, self.target, self.return_k_s)),
        ] {
            time_ms = time_ms.saturating_add(duration_ms);
            let point = CoursePoint { time_ms, temperature };
            // Without a hold the third point is the second one.
            if course.points().last() != Some(&point) {
                course.push(point)?;
            }
        }
        course.check_whole()
    }
}

/// Duration of a ramp, ms, rounded up, at least 1.
#[inline(never)]
fn duration_ms(from: Celsius, to: Celsius, rate_k_s: Celsius) -> u32 {
    let way = u64::from(from.abs_diff(to).to_bits()) * 1000;
    way.div_ceil(u64::from(rate_k_s.to_bits().unsigned_abs().max(1))).max(1) as u32
}

#[inline(never)]
fn read_celsius(words: &mut Words<'_>, range: &'static Range) -> Result<Celsius, Error> {
    Ok(saturated(read_fixed_point_in_range(words, range)?))
}

#[inline(never)]
fn read_milliseconds(words: &mut Words<'_>) -> Result<u32, Error> {
    let seconds = read_fixed_point_in_range(words, &TIME_RANGE)?;
    let milliseconds = seconds.saturating_mul_int(1000).round();
    Ok((milliseconds.to_bits() >> I32F32::FRAC_NBITS) as u32)
}

pub fn parse_hold(words: &mut Words<'_>) -> Result<Command<'static>, Error> {
    let celsius = read_celsius(words, &TEMPERATURE_RANGE)?;
    let rate_k_s = match words.clone().next() {
        Some(_) => read_celsius(words, &RATE_RANGE)?,
        None => Hold::DEFAULT_RATE_K_S,
    };
    Ok(Command::Hold { target: Setpoint::clamp_celsius_with_flag(celsius).0, rate_k_s })
}

#[inline(never)]
pub fn parse_play(words: &mut Words<'_>) -> Result<PlayOrder, Error> {
    let word = word_or_empty(words);
    let (_, start) = table_entry_for_word_or_none(&CourseStart::PROTOCOL_WORDS, word)
        .ok_or(Error::UnknownCourseStart(word.into()))?;
    let mut order = PlayOrder { start, play_count: 1, end: CourseEnd::default() };
    let is_number = |word: &str| !word.starts_with(|first: char| first.is_ascii_alphabetic());
    if words.clone().next().is_some_and(is_number) {
        order.play_count = read_whole_number_in_range(words, &TIMES_RANGE)? as u16;
    }
    if let Some(word) = words.next() {
        (_, order.end) = table_entry_for_word_or_none(&CourseEnd::PROTOCOL_WORDS, word)
            .ok_or(Error::UnknownCourseEnd(word.into()))?;
    }
    Ok(order)
}

pub fn parse_pulse(words: &mut Words<'_>) -> Result<Pulse, Error> {
    Ok(Pulse {
        base: read_celsius(words, &TEMPERATURE_RANGE)?,
        target: read_celsius(words, &TEMPERATURE_RANGE)?,
        rise_k_s: read_celsius(words, &RATE_RANGE)?,
        hold_ms: read_milliseconds(words)?,
        return_k_s: read_celsius(words, &RATE_RANGE)?,
        order: match words.clone().next() {
            Some(_) => parse_play(words)?,
            None => PlayOrder { start: CourseStart::Now, play_count: 1, end: CourseEnd::default() },
        },
    })
}

pub fn parse_skin(words: &mut Words<'_>) -> Result<Option<Celsius>, Error> {
    let word = words.clone().next().unwrap_or_default();
    if word == "sensor" {
        words.next();
        return Ok(None);
    }
    match read_celsius(words, &SKIN_RANGE) {
        Err(Error::NotANumber(range, word)) => Err(Error::UnknownSkin(range, word)),
        celsius => celsius.map(Some),
    }
}

pub fn read_temperature_kind(words: &mut Words<'_>) -> Result<TemperatureKind, Error> {
    let word = word_or_empty(words);
    let (_, temperatures) = table_entry_for_word_or_none(&TemperatureKind::PROTOCOL_WORDS, word)
        .ok_or(Error::UnknownTemperatureKind(word.into()))?;
    Ok(temperatures)
}

pub fn read_course_point(
    words: &mut Words<'_>,
    temperatures: TemperatureKind,
) -> Result<CoursePoint, Error> {
    let range = match temperatures {
        TemperatureKind::Absolute => &TEMPERATURE_RANGE,
        TemperatureKind::AboveSkin => &RELATIVE_TEMPERATURE_RANGE,
    };
    Ok(CoursePoint { time_ms: read_milliseconds(words)?, temperature: read_celsius(words, range)? })
}

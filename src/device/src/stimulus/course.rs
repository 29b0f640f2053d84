//! A course: temperatures of the display over time, linear between points.

use contact_model::fixed_point::Celsius;
use heapless::Vec;
use thermal_settings::vocabulary;

use super::dose_of_course::{EquivalentTime, time_equivalent_to_largest};
use crate::safety::PredictedDose;
use crate::safety::limits::{DOSE_COUNTED_FROM, SETPOINT_MAX, SETPOINT_MIN};

/// Largest number of points of a course.
pub const COURSE_POINTS_MAX: usize = 128;
/// Longest course, ms: one hour.
pub const COURSE_DURATION_MAX_MS: u32 = 3_600_000;
/// Steepest course and fastest `hold`, K/s. No tile gives as much; a course this steep asks for a step, and is reported as
/// `limited` while the display lags behind it.
pub const COURSE_RATE_MAX_K_S: u32 = 100;

/// Largest temperature of a relative course, K, above or below the skin: the width of the range of set-points.
const RELATIVE_MAX: Celsius = SETPOINT_MAX.saturating_sub(SETPOINT_MIN);

vocabulary! {
    /// What the temperatures of a course are.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum TemperatureKind: "temperatures" {
        /// °C.
        #[default]
        Absolute = "absolute",
        /// K above the skin before contact.
        AboveSkin = "relative",
    }
}

impl TemperatureKind {
    /// Smallest and largest temperature of a point, °C or K.
    pub const fn range(self) -> (Celsius, Celsius) {
        match self {
            Self::Absolute => (SETPOINT_MIN, SETPOINT_MAX),
            Self::AboveSkin => (RELATIVE_MAX.saturating_neg(), RELATIVE_MAX),
        }
    }
}

/// A point of a course.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoursePoint {
    /// Time since the start of the course, ms.
    pub time_ms: u32,
    /// Temperature, °C, or K above the skin.
    pub temperature: Celsius,
}

/// Points of a [`CourseChunk`]. Copying them takes about a microsecond.
const CHUNK_POINTS: usize = 32;

/// A few points of a course, so that copying the course does not lock out the control tick for long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CourseChunk<'a> {
    course: &'a Course,
    /// Index of the chunk's first point.
    first: usize,
}

/// Why a point or a course is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseError {
    /// There is no room for more than [`COURSE_POINTS_MAX`] points.
    TooManyPoints,
    /// The point at the first of these times, ms, is not later than the one before, at the second.
    TimeGoesBack(u32, u32),
    /// The point, at this time, ms, is later than [`COURSE_DURATION_MAX_MS`].
    TooLong(u32),
    /// The point's temperature is out of range.
    OutOfRange,
    /// From the point before to this one the temperature changes by this rate, K/s, which is more than
    /// [`COURSE_RATE_MAX_K_S`].
    TooFast(u32),
    /// A course has at least two points.
    TooFewPoints,
    /// The course alone gives this thermal dose, ms at 43 °C, which reaches the limit.
    TooHotForTooLong(u32),
}

/// A course: its points are in order, in range, and not too steep. One that has passed [`Self::check_whole`] has at least two
/// points, and by itself gives no dose that trips.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Course {
    points: Vec<CoursePoint, COURSE_POINTS_MAX>,
    kind: TemperatureKind,
    smallest: Celsius,
    largest: Celsius,
    /// Fastest rate between two points, K/s, less the rounding of their temperatures.
    fastest_k_s: Celsius,
    /// Time at the largest temperature that gives the dose of the course; set by [`Self::check_whole`].
    equivalent: EquivalentTime,
}

impl Default for Course {
    fn default() -> Self {
        Self::new(TemperatureKind::default())
    }
}

impl Course {
    /// A course without points yet.
    pub const fn new(kind: TemperatureKind) -> Self {
        Self {
            points: Vec::new(),
            kind,
            smallest: Celsius::MAX,
            largest: Celsius::MIN,
            fastest_k_s: Celsius::ZERO,
            equivalent: EquivalentTime::ZERO,
        }
    }

    /// Removes all points. In place, where a new course would be a kilobyte on the stack.
    pub fn clear(&mut self, kind: TemperatureKind) {
        self.points.clear();
        self.kind = kind;
        self.smallest = Celsius::MAX;
        self.largest = Celsius::MIN;
        self.fastest_k_s = Celsius::ZERO;
        self.equivalent = EquivalentTime::ZERO;
    }

    /// The course in chunks, for [`Self::copy_chunk`].
    pub fn chunks(&self) -> impl Iterator<Item = CourseChunk<'_>> {
        let chunk = |first| CourseChunk { course: self, first };
        (0..self.points.len()).step_by(CHUNK_POINTS).map(chunk)
    }

    /// Copies a chunk of another course, after the chunks before it. Returns whether this course is then the whole other one.
    pub fn copy_chunk(&mut self, chunk: &CourseChunk<'_>) -> bool {
        let &CourseChunk { course, first } = chunk;
        self.points.truncate(first);
        let points = course.points.chunks(CHUNK_POINTS).nth(first / CHUNK_POINTS);
        let follows = self.points.len() == first
            && points.is_some_and(|points| self.points.extend_from_slice(points).is_ok());
        self.kind = course.kind;
        self.smallest = course.smallest;
        self.largest = course.largest;
        self.fastest_k_s = course.fastest_k_s;
        self.equivalent = course.equivalent;
        follows && self.points.len() == course.points.len()
    }

    /// Adds a point.
    ///
    /// # Errors
    /// The point does not fit behind the ones before; the course is unchanged.
    pub fn push(&mut self, point: CoursePoint) -> Result<(), CourseError> {
        let (min, max) = self.kind.range();
        if point.time_ms > COURSE_DURATION_MAX_MS {
            return Err(CourseError::TooLong(point.time_ms));
        }
        if !(min..=max).contains(&point.temperature) {
            return Err(CourseError::OutOfRange);
        }
        let mut rate_k_s = Celsius::ZERO;
        if let Some(before) = self.points.last() {
            if point.time_ms <= before.time_ms {
                return Err(CourseError::TimeGoesBack(point.time_ms, before.time_ms));
            }
            let way = point.temperature.abs_diff(before.temperature).to_bits();
            let duration_ms = point.time_ms - before.time_ms;
            // In steps of 2^-22 K per ms.
            const RATE_MAX: u64 = ((COURSE_RATE_MAX_K_S as u64) << Celsius::FRAC_NBITS) / 1000;
            let rate = |way: u32| u64::from(way) * 1000 / u64::from(duration_ms);
            // One step more, so that a rate at the limit is not refused for the rounding of its temperatures.
            if u64::from(way) > (RATE_MAX + 1) * u64::from(duration_ms) {
                let half = 1 << (Celsius::FRAC_NBITS - 1);
                return Err(CourseError::TooFast(
                    ((rate(way) + half) >> Celsius::FRAC_NBITS) as u32,
                ));
            }
            // One step less, for the same rounding.
            rate_k_s = Celsius::from_bits(rate(way.saturating_sub(1)) as i32);
        }
        (self.points.push(point)).map_err(|_| CourseError::TooManyPoints)?;
        self.smallest = self.smallest.min(point.temperature);
        self.largest = self.largest.max(point.temperature);
        self.fastest_k_s = self.fastest_k_s.max(rate_k_s);
        Ok(())
    }

    /// Checks the course as a whole, and predicts its dose. Takes up to some milliseconds, so it is not for the control
    /// tick.
    ///
    /// # Errors
    /// There are less than two points, or the dose of the course alone trips.
    pub fn check_whole(&mut self) -> Result<(), CourseError> {
        if self.points.len() < 2 {
            return Err(CourseError::TooFewPoints);
        }
        let counted_from = match self.kind {
            TemperatureKind::Absolute => DOSE_COUNTED_FROM,
            // No set-point is above 42 °C, so what is 3 K below the largest temperature is never counted.
            TemperatureKind::AboveSkin => {
                self.largest.saturating_sub(SETPOINT_MAX.saturating_sub(DOSE_COUNTED_FROM))
            }
        };
        self.equivalent = time_equivalent_to_largest(&self.points, self.largest, counted_from);
        if self.kind == TemperatureKind::Absolute {
            let dose = self.dose(Celsius::ZERO);
            if dose.reaches_limit() {
                return Err(CourseError::TooHotForTooLong(dose.milliseconds_at_43()));
            }
        }
        Ok(())
    }

    /// Dose of the course if its temperatures are this much, °C, above what its points say. An upper bound: of a relative
    /// course with a largest temperature of 39 to 42 °C it also counts what is below 39 °C, down to 3 K below that largest one.
    pub fn dose(&self, base: Celsius) -> PredictedDose {
        let largest = self.largest.saturating_add(base);
        if largest < DOSE_COUNTED_FROM {
            return PredictedDose::from_sum(0);
        }
        self.equivalent.at(largest)
    }

    /// The points.
    pub fn points(&self) -> &[CoursePoint] {
        &self.points
    }

    /// What the temperatures of the points are.
    pub const fn temperature_kind(&self) -> TemperatureKind {
        self.kind
    }

    /// Temperature of the first point, °C; 0 for a course without points.
    pub fn first_temperature(&self) -> Celsius {
        (self.points.first()).map_or(Celsius::ZERO, |point| point.temperature)
    }

    /// Smallest and largest temperature of the points, °C, or K above the skin.
    pub const fn extremes(&self) -> (Celsius, Celsius) {
        (self.smallest, self.largest)
    }

    /// Fastest rate between two points, K/s, less the rounding of their temperatures.
    pub const fn fastest_k_s(&self) -> Celsius {
        self.fastest_k_s
    }
}

#[cfg(test)]
mod tests;

//! Courses of temperature that a display follows, on the host: reading, reducing and uploading them.
//!
//! ```text
//! CSV file -> read_course -> CourseFile -> Prepared: at most 128 points, none of which a device refuses -> upload_lines -> device
//! ```

mod prepared;
mod read;
mod reduce;

pub use prepared::Prepared;
pub use read::{ALLOWED_C, CourseFile, CourseFileError, Selection, read_course};
pub use reduce::{Reduced, reduce};

use thermal_device::stimulus::TemperatureKind;

use crate::client::{UploadLine, upload_course};

pub use thermal_device::stimulus::COURSE_POINTS_MAX;
/// Largest error of a reduction that is played without being asked for, K.
pub const REDUCTION_ERROR_MAX_K: f64 = 5e-3;
/// Steps in which a course's times, s, and temperatures, °C, are told to a device: 1 ms and 0.1 mK.
const TICKS_PER_S: f64 = 1e3;
const STEPS_PER_K: f64 = 1e4;

/// A point of a course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoursePoint {
    /// Time since the course began, s.
    pub t_s: f64,
    /// Temperature, °C.
    pub celsius: f64,
}

/// Temperature over time: linear between its points, constant before the first and after the last. It has at least one
/// point, all numbers are finite, and times rise.
#[derive(Clone, Debug, PartialEq)]
pub struct Course(Vec<CoursePoint>);

/// Why points are no course.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CourseError {
    /// There is none.
    #[error("a course has at least one point")]
    Empty,
    /// A number that is not finite.
    #[error("point {index} has a number that is not finite")]
    NotFinite {
        /// Index of the point.
        index: usize,
    },
    /// A time before zero, or not after that of the point before.
    #[error("time {t_s} s of point {index} must be after {after_s} s")]
    Time {
        /// Index of the point.
        index: usize,
        /// Its time, s.
        t_s: f64,
        /// The time that it must exceed, s; zero itself is allowed for the first point.
        after_s: f64,
    },
}

impl Course {
    /// Checks the points of a course.
    ///
    /// # Errors
    /// There is none, a number is not finite, or a time is negative or does not rise.
    pub fn new(points: Vec<CoursePoint>) -> Result<Self, CourseError> {
        let mut after_s = None;
        for (index, point) in points.iter().enumerate() {
            if !(point.t_s.is_finite() && point.celsius.is_finite()) {
                return Err(CourseError::NotFinite { index });
            }
            if after_s.map_or(point.t_s < 0.0, |after_s| point.t_s <= after_s) {
                return Err(CourseError::Time {
                    index,
                    t_s: point.t_s,
                    after_s: after_s.unwrap_or(0.0),
                });
            }
            after_s = Some(point.t_s);
        }
        if points.is_empty() {
            return Err(CourseError::Empty);
        }
        Ok(Self(points))
    }

    /// The points.
    pub fn points(&self) -> &[CoursePoint] {
        &self.0
    }

    /// Time of the last point, s.
    pub fn duration_s(&self) -> f64 {
        self.0.last().map_or(0.0, |point| point.t_s)
    }

    /// Temperature at a time, °C.
    pub fn at(&self, t_s: f64) -> f64 {
        let next = self.0.partition_point(|point| point.t_s <= t_s);
        match (next.checked_sub(1).map(|i| self.0[i]), self.0.get(next)) {
            (Some(before), Some(after)) => {
                let fraction = (t_s - before.t_s) / (after.t_s - before.t_s);
                before.celsius + fraction * (after.celsius - before.celsius)
            }
            (Some(last), None) => last.celsius,
            (None, Some(first)) => first.celsius,
            (None, None) => f64::NAN,
        }
    }

    /// Largest difference to another course at any time from zero to the end of both, K.
    pub fn largest_difference_k(&self, other: &Self) -> f64 {
        // Both are linear between all their points, and constant outside of them.
        let times = self.0.iter().chain(&other.0).map(|point| point.t_s);
        times.fold(0.0, |largest, t_s| {
            let difference: f64 = self.at(t_s) - other.at(t_s);
            difference.abs().max(largest)
        })
    }

    /// The course as a device is told it: in whole milliseconds and tenths of a millikelvin. Of points in the same
    /// millisecond the last stays.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let mut points: Vec<CoursePoint> = Vec::new();
        for point in &self.0 {
            let rounded = CoursePoint {
                t_s: (point.t_s * TICKS_PER_S).round() / TICKS_PER_S,
                celsius: (point.celsius * STEPS_PER_K).round() / STEPS_PER_K,
            };
            if points.last().is_some_and(|last| last.t_s >= rounded.t_s) {
                points.pop();
            }
            points.push(rounded);
        }
        Self(points)
    }

    /// The course that follows this one with rates of change of at most `limit_k_s`, K/s, beginning on its first point.
    #[must_use]
    pub fn rate_limited(&self, limit_k_s: f64) -> Self {
        let mut points = vec![self.0[0]];
        let mut at = self.0[0];
        for segment in self.0.windows(2) {
            let (from, to) = (segment[0], segment[1]);
            let slope_k_s = (to.celsius - from.celsius) / (to.t_s - from.t_s);
            let behind_k = from.celsius - at.celsius;
            // Approaches the course as fast as allowed, and then stays on it as long as it is slow enough.
            let approach_k_s = if behind_k == 0.0 {
                slope_k_s.clamp(-limit_k_s, limit_k_s)
            } else {
                limit_k_s.copysign(behind_k)
            };
            let span_s = to.t_s - from.t_s;
            let reached_s = behind_k / (approach_k_s - slope_k_s);
            if behind_k != 0.0 && reached_s > 0.0 && reached_s < span_s {
                let t_s = from.t_s + reached_s;
                at = CoursePoint { t_s, celsius: from.celsius + slope_k_s * reached_s };
                points.push(at);
                let rest_k_s = slope_k_s.clamp(-limit_k_s, limit_k_s);
                at = CoursePoint { t_s: to.t_s, celsius: at.celsius + rest_k_s * (to.t_s - t_s) };
            } else {
                at = CoursePoint { t_s: to.t_s, celsius: at.celsius + approach_k_s * span_s };
            }
            if (at.celsius - to.celsius).abs() < 1e-9 {
                at.celsius = to.celsius;
            }
            points.push(at);
        }
        let last = self.0[self.0.len() - 1];
        if at.celsius != last.celsius {
            points.push(CoursePoint {
                t_s: at.t_s + (last.celsius - at.celsius).abs() / limit_k_s,
                celsius: last.celsius,
            });
        }
        Self(points)
    }

    /// Largest rate of change, K/s; 0 for one point.
    pub fn rate_max_k_s(&self) -> f64 {
        let rates = self.0.windows(2).map(|segment| {
            ((segment[1].celsius - segment[0].celsius) / (segment[1].t_s - segment[0].t_s)).abs()
        });
        rates.fold(0.0, f64::max)
    }

    /// The points as CSV of two columns, which [`read_course`] reads.
    pub fn csv(&self) -> String {
        let rows = self.0.iter();
        let rows = rows.map(|point| format!("{:.3},{:.4}\n", point.t_s, point.celsius));
        "t_s,celsius\n".to_owned() + &rows.collect::<String>()
    }

    /// The lines that upload the course to a device, with absolute temperatures.
    pub fn upload_lines(&self) -> Vec<UploadLine> {
        let points: Vec<_> = (self.0.iter()).map(|point| (point.t_s, point.celsius)).collect();
        upload_course(TemperatureKind::Absolute, &points)
    }
}

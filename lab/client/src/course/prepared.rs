//! A course made ready for a device.

use contact_model::fixed_point::Celsius;
use thermal_device::command::Refused;
use thermal_device::safety::ThermalDose;
use thermal_device::stimulus::{self, TemperatureKind};
use thermal_protocol::Error;

use super::{
    COURSE_POINTS_MAX, Course, CourseFile, CourseFileError, REDUCTION_ERROR_MAX_K, TICKS_PER_S,
    reduce,
};

/// A course, and the points of it that a device is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Prepared {
    /// The course as it was.
    pub whole: Course,
    /// The points for the device: reduced to their largest number, and rounded.
    pub points: Course,
    /// Largest difference of both, K.
    pub error_k: f64,
}

impl Prepared {
    /// Reduces and rounds a course that is to be played so many times, and makes the device's own checks of it, so that a
    /// course that it refuses is refused before anything is armed.
    ///
    /// # Errors
    /// The error of the reduction is above [`REDUCTION_ERROR_MAX_K`], unless a coarse course is asked for; or the course is too
    /// long, too fast, or gives too large a dose even if the skin has taken none before.
    pub fn new(file: CourseFile, coarse: bool, play_count: u16) -> Result<Self, CourseFileError> {
        let points = reduce(&file.course, COURSE_POINTS_MAX).course.rounded();
        let error_k = points.largest_difference_k(&file.course);
        if error_k > REDUCTION_ERROR_MAX_K && !coarse {
            return Err(file.wrong(format!(
                "with {COURSE_POINTS_MAX} points, which a device can hold, the course is {:.1} mK off; up to {:.0} mK are \
                 allowed without --coarse",
                1e3 * error_k,
                1e3 * REDUCTION_ERROR_MAX_K
            )));
        }
        check_as_device(&file, &points, play_count)?;
        Ok(Self { whole: file.course, points, error_k })
    }
}

/// What a device that has its default settings, and no dose yet, checks of an upload and of `play`.
fn check_as_device(
    file: &CourseFile,
    points: &Course,
    play_count: u16,
) -> Result<(), CourseFileError> {
    let mut course = stimulus::Course::new(TemperatureKind::Absolute);
    for point in points.points() {
        // A time beyond the range stays beyond that of a device, which ends after an hour.
        let time_ms = (point.t_s * TICKS_PER_S).round() as u32;
        let pushed = course.push(stimulus::CoursePoint {
            time_ms,
            temperature: Celsius::saturating_from_num(point.celsius),
        });
        pushed.map_err(|error| file.wrong_at(point.t_s, words(Error::Course(error))))?;
    }
    course.check_whole().map_err(|error| file.wrong(words(Error::Course(error))))?;
    let dose = course.dose(Celsius::ZERO).repeated_on_top_of(play_count, &ThermalDose::default());
    if dose.reaches_limit() {
        let refused = words(Refused::CourseDose(dose).into());
        return Err(file.wrong(format!("played {play_count} times it is {refused}")));
    }
    Ok(())
}

/// A refusal in the words of the device, without the one that each of its refusals begins with.
fn words(error: Error) -> String {
    let line = error.to_string();
    line.strip_prefix("err ").unwrap_or(&line).to_owned()
}

//! A course made ready for a device.

use super::{COURSE_POINTS_MAX, Course, REDUCTION_ERROR_MAX_K, reduce};

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

/// Why a course is not played without being asked for.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "with {COURSE_POINTS_MAX} points, which a device can hold, the course is {:.1} mK off; up to {:.0} mK are allowed without \
     --coarse",
    1e3 * error_k, 1e3 * REDUCTION_ERROR_MAX_K
)]
pub struct TooCoarse {
    /// Error of the reduction, K.
    pub error_k: f64,
}

impl Prepared {
    /// Reduces and rounds a course.
    pub fn new(whole: Course) -> Self {
        let points = reduce(&whole, COURSE_POINTS_MAX).course.rounded();
        Self { error_k: points.largest_difference_k(&whole), points, whole }
    }

    /// This course if its error is at most [`REDUCTION_ERROR_MAX_K`], or if a coarse one is asked for.
    ///
    /// # Errors
    /// The error is larger.
    pub fn fine_enough(self, coarse: bool) -> Result<Self, TooCoarse> {
        if coarse || self.error_k <= REDUCTION_ERROR_MAX_K {
            return Ok(self);
        }
        Err(TooCoarse { error_k: self.error_k })
    }
}

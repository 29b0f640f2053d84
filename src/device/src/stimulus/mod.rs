//! Temperatures that the host prescribes instead of an object: a temperature that is held, and courses.
//!
//! ```text
//! upload --> Course --> CourseMemory --- play --> Player --> set-point now, and 14 ms ahead --> reference
//!                                                   ^
//! hold ------------------------------------> Hold --+-- temperature_on_line: exact interpolation in integers
//! ```

mod approach;
mod course;
mod course_memory;
mod dose_of_course;
mod hold;
mod line;
mod player;

pub use approach::Approach;
pub use course::{
    COURSE_DURATION_MAX_MS, COURSE_POINTS_MAX, COURSE_RATE_MAX_K_S, Course, CourseChunk,
    CourseError, CoursePoint, TemperatureKind,
};
pub use course_memory::CourseMemory;
pub use hold::Hold;
pub use player::{CourseEnd, CourseStart, PlayOrder, Player};

use contact_model::fixed_point::Celsius;

/// Time, ticks of 1 ms, by which the target of the control law is ahead of the set-point of a hold or a course. The law
/// `model` reaches its target after 12 ms; one tick passes until its current flows, and the plate answers 1 ms later than its
/// model. With 12 the display is 10 mK, 2 ms, behind a ramp of 5 K/s.
pub const STIMULUS_LEAD_TICKS: u32 = 14;
/// Distance, K, of the display's surface from the set-point of a hold or a course from which on the set-point is
/// reported as `limited`: the tile cannot keep the rate.
pub const FOLLOWING_ERROR_REPORTED: Celsius = Celsius::lit("0.1");

/// What the display does in the state stimulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Stimulus {
    /// The set-point moves to a temperature and stays there.
    Hold(Hold),
    /// A course waits on its first point, which the display approaches, for what starts it.
    Wait(PlayOrder, Approach),
    /// A course plays.
    Play(Player),
}

/// Set-point of one tick, and the target of the control law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StimulusTemperatures {
    /// Temperature of this tick, °C.
    pub now: Celsius,
    /// What the law aims at, °C: the set-point [`STIMULUS_LEAD_TICKS`] later, or a part of the way to a constant one.
    pub target: Celsius,
}

//! A course that plays: its set-point now and when the control law will have reached its target.

use contact_model::fixed_point::Celsius;
use thermal_settings::vocabulary;

use super::line::temperature_on_line;
use super::{CoursePoint, STIMULUS_LEAD_TICKS, StimulusTemperatures};

vocabulary! {
    /// What starts a course.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum CourseStart: "start of a course" {
        /// The tick after the command `play`.
        Now = "now",
        /// The next edge at the trigger input; until then the display waits on the first point.
        Trigger = "trigger",
        /// The next landing of a finger; until then the display waits on the first point.
        Landing = "landing",
    }
}

vocabulary! {
    /// What the display does after a course.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum CourseEnd: "end of a course" {
        /// Stays on the last point.
        #[default]
        Hold = "hold",
        /// Returns to skin temperature, in the state armed.
        Neutral = "neutral",
    }
}

/// The command `play`: when the loaded course starts, how often it is repeated, and what follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlayOrder {
    /// What starts it.
    pub start: CourseStart,
    /// How many times it is played, 1 or more.
    pub play_count: u16,
    /// What follows.
    pub end: CourseEnd,
}

impl PlayOrder {
    /// From the next tick on, once, and the display stays on the last point.
    pub const ONCE_NOW: Self =
        Self { start: CourseStart::Now, play_count: 1, end: CourseEnd::Hold };
}

/// A place in a course that is played one or more times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    /// Time since the course has begun, or begun again, ms.
    time_ms: u32,
    /// How many times the course is played after this time.
    times_left: u16,
}

impl Place {
    /// The place `ticks` later in a course of this duration; at the end of the course it stays. The course is on its last point at
    /// its end, and begins again in the tick after: that is 1 ms after its start.
    fn later(self, ticks: u32, duration_ms: u32) -> Self {
        let time_ms = self.time_ms.saturating_add(ticks);
        // Every course has a duration, because it has two points; without one no time is behind it.
        let ended = (time_ms.saturating_sub(1).checked_div(duration_ms)).unwrap_or(0);
        match u32::from(self.times_left).checked_sub(ended) {
            Some(times_left) => {
                Self { time_ms: time_ms - ended * duration_ms, times_left: times_left as u16 }
            }
            None => Self { time_ms: duration_ms, times_left: 0 },
        }
    }

    /// The temperature of this place, °C. Before the first point it is that of the first. Searched for anew in each tick, in at most
    /// eight steps, so that a tick does the same work however many points have passed since the last one.
    #[inline(never)]
    fn temperature(self, points: &[CoursePoint]) -> Celsius {
        let next = points.partition_point(|point| point.time_ms <= self.time_ms);
        let last_passed = next.checked_sub(1).and_then(|last| points.get(last));
        match (last_passed, points.get(next)) {
            (Some(from), Some(to)) => temperature_on_line(
                from.temperature,
                to.temperature,
                self.time_ms - from.time_ms,
                to.time_ms - from.time_ms,
            ),
            (Some(only), None) | (None, Some(only)) => only.temperature,
            (None, None) => Celsius::ZERO,
        }
    }
}

/// A course that plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Player {
    place: Place,
    /// What is added to the temperatures of the points, °C: the skin for a relative course, else 0.
    base: Celsius,
    end: CourseEnd,
}

impl Player {
    /// Plays a course that has `elapsed` ticks behind it in the first tick.
    pub fn new(points: &[CoursePoint], base: Celsius, order: &PlayOrder, elapsed: u32) -> Self {
        let start = Place { time_ms: 0, times_left: order.play_count.saturating_sub(1) };
        Self { place: start.later(elapsed, duration_ms(points)), base, end: order.end }
    }

    /// The set-points of this tick, with what follows if the course ends in it. Moves on by one tick.
    pub fn next_temperatures(
        &mut self,
        points: &[CoursePoint],
    ) -> (StimulusTemperatures, Option<CourseEnd>) {
        let duration_ms = duration_ms(points);
        let place = self.place;
        let ahead = place.later(STIMULUS_LEAD_TICKS, duration_ms);
        let temperatures = StimulusTemperatures {
            now: place.temperature(points).saturating_add(self.base),
            target: ahead.temperature(points).saturating_add(self.base),
        };
        let is_at_end = place.times_left == 0 && place.time_ms >= duration_ms;
        self.place = place.later(1, duration_ms);
        (temperatures, is_at_end.then_some(self.end))
    }
}

/// Duration of a course, ms: the time of its last point.
fn duration_ms(points: &[CoursePoint]) -> u32 {
    points.last().map_or(0, |point| point.time_ms)
}

#[cfg(test)]
mod tests;

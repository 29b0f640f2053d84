//! A course that plays: its set-point now and when the control law will have reached its target.

use contact_model::fixed_point::Celsius;

use super::ramp::Ramp;
use super::{CoursePoint, STIMULUS_LEAD_TICKS, StimulusTemperatures};

/// What starts a course.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseStart {
    /// The tick after the command `play`.
    Now,
    /// The next edge at the trigger input; until then the display waits on the first point.
    Trigger,
    /// The next landing of a finger; until then the display waits on the first point.
    Landing,
}

impl CourseStart {
    /// All, with their words in the protocol.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 3] = [
        ("now", Self::Now),
        ("trigger", Self::Trigger),
        ("landing", Self::Landing),
    ];

    /// Its word in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Now => "now",
            Self::Trigger => "trigger",
            Self::Landing => "landing",
        }
    }
}

/// What the display does after a course.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CourseEnd {
    /// Stays on the last point.
    #[default]
    Hold,
    /// Returns to skin temperature, in the state armed.
    Neutral,
}

impl CourseEnd {
    /// Both, with their words in the protocol.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 2] =
        [("hold", Self::Hold), ("neutral", Self::Neutral)];
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

/// A place in a course that is played one or more times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cursor {
    /// The segment on which the place is.
    ramp: Ramp,
    /// Index of the point on which the segment ends.
    point: u8,
    /// How many times the course is played after this time.
    times_left: u16,
}

impl Cursor {
    /// The start of a course. Before its first point it has the temperature of that point.
    fn new(points: &[CoursePoint], times: u16) -> Self {
        Self {
            ramp: points
                .first()
                .map_or(Ramp::constant(Celsius::ZERO), |first| {
                    Ramp::new(first.temperature, first.temperature, first.time_ms)
                }),
            point: 0,
            times_left: times.saturating_sub(1),
        }
    }

    /// Moves on to the next segment if the present one has ended. Returns false at the end of the course.
    #[inline(never)]
    fn enter_segment(&mut self, points: &[CoursePoint]) -> bool {
        // Ends, because each round takes the next point or one of the repetitions. Only the first segment has no ticks, if
        // the first point is at 0.
        while self.ramp.ticks_left() == 0 {
            let end = usize::from(self.point);
            if let (Some(from), Some(to)) = (points.get(end), points.get(end + 1)) {
                let ticks = to.time_ms.saturating_sub(from.time_ms);
                self.ramp = Ramp::new(from.temperature, to.temperature, ticks);
                self.point += 1;
            } else if self.times_left > 0 {
                *self = Self::new(points, self.times_left);
            } else {
                return false;
            }
        }
        true
    }

    /// Moves on by `ticks`; at the end of the course it stays.
    #[inline(never)]
    fn advance(&mut self, points: &[CoursePoint], mut ticks: u32) {
        while ticks > 0 && self.enter_segment(points) {
            ticks -= self.ramp.skip(ticks);
        }
    }

    fn is_at_end(&self, points: &[CoursePoint]) -> bool {
        self.ramp.ticks_left() == 0
            && self.times_left == 0
            && usize::from(self.point) + 1 >= points.len()
    }
}

/// A course that plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Player {
    now: Cursor,
    ahead: Cursor,
    /// What is added to the temperatures of the points, °C: the skin for a relative course, else 0.
    base: Celsius,
    end: CourseEnd,
}

impl Player {
    /// Plays these points, which have `elapsed` ticks of the course behind them in the first tick.
    #[must_use]
    pub fn new(points: &[CoursePoint], base: Celsius, order: &PlayOrder, elapsed: u32) -> Self {
        let mut now = Cursor::new(points, order.play_count);
        now.advance(points, elapsed);
        let mut ahead = now;
        ahead.advance(points, STIMULUS_LEAD_TICKS);
        Self {
            now,
            ahead,
            base,
            end: order.end,
        }
    }

    /// The set-points of this tick, with what follows if the course ends in it. Moves on by one tick.
    pub fn next_temperatures(
        &mut self,
        points: &[CoursePoint],
    ) -> (StimulusTemperatures, Option<CourseEnd>) {
        let temperatures = StimulusTemperatures {
            now: self.now.ramp.celsius().saturating_add(self.base),
            target: self.ahead.ramp.celsius().saturating_add(self.base),
        };
        let ended = self.now.is_at_end(points).then_some(self.end);
        self.now.advance(points, 1);
        self.ahead.advance(points, 1);
        (temperatures, ended)
    }
}

#[cfg(test)]
mod tests;

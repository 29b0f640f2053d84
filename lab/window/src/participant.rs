//! What the participant may see. The participant's views are drawn from nothing else: it has no temperature, no material and
//! no level, which would tell what is presented.

use std::collections::VecDeque;
use std::time::Duration;

use thermal_session::{Cue, Phase, Question};

/// Length of the line of the force, s.
const FOLLOW_S: f64 = 10.0;
/// Most points of that line.
const FOLLOW_POINTS_MAX: usize = 2000;
/// Range of the force, as a factor of the target.
const FOLLOW_RANGE: f64 = 1.5;

/// What the participant sees.
#[derive(Clone, Debug, Default)]
pub struct ParticipantView {
    /// Text without a question.
    pub instruction: Option<String>,
    /// The last tone, until something else is to be done.
    pub cue: Option<ShownCue>,
    /// What is asked.
    pub question: Option<Question>,
    /// Whether the question was answered at this window.
    pub answered: bool,
    /// Force that is to be followed.
    pub follow: Option<Follow>,
    /// Names of the stations, for an answer that has a number for each.
    pub stations: Vec<String>,
    /// Phase of the session.
    pub phase: Option<Phase>,
    /// Whether the session waits for the operator.
    pub waits: bool,
    /// Whether the session has ended.
    pub ended: bool,
}

/// A tone that is shown, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownCue {
    /// The tone.
    pub cue: Cue,
    /// When it was requested.
    pub at: Duration,
}

/// A force that the participant follows.
#[derive(Clone, Debug, PartialEq)]
pub struct Follow {
    /// Target, N.
    pub target_n: f64,
    /// When it was first shown.
    pub since: Duration,
    /// Forces, N, and when they came.
    pub forces: VecDeque<(Duration, f64)>,
}

impl Follow {
    pub(crate) fn new(target_n: f64, since: Duration) -> Self {
        Self { target_n, since, forces: VecDeque::new() }
    }

    pub(crate) fn add(&mut self, force_n: f64, at: Duration) {
        self.forces.push_back((at, force_n));
        let old = |(then, _): &(Duration, f64)| (at.saturating_sub(*then)).as_secs_f64() > FOLLOW_S;
        while self.forces.len() > FOLLOW_POINTS_MAX || self.forces.front().is_some_and(old) {
            self.forces.pop_front();
        }
    }

    /// The upper end of the range that is shown, N.
    pub fn range_n(&self) -> f64 {
        FOLLOW_RANGE * self.target_n
    }
}

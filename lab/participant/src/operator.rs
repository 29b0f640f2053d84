//! The simulated operator, and what happens to a session on purpose.

use thermal_session::{Decision, OperatorQuestion, Phase};
use thermal_sim::scene::ActiveFault;

/// Something that happens in a trial on purpose, for tests of sessions.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedEvent {
    /// Number of the trial.
    pub trial: u32,
    /// Number of the attempt at it, from 1; `None` for all.
    pub attempt: Option<u32>,
    /// What happens.
    pub what: Happening,
}

/// What happens on purpose.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// The operator decides so when this phase begins.
    Decides(Phase, Decision),
    /// The plant of the device's first finger has a fault from a time after the trial's begin on, for a time.
    Fault {
        /// The fault.
        fault: ActiveFault,
        /// Begin after that of the trial, s.
        from_s: f64,
        /// Duration, s.
        for_s: f64,
    },
    /// The same, from a time after the first landing on.
    FaultAfterLanding {
        /// The fault.
        fault: ActiveFault,
        /// Begin after the landing, s.
        from_s: f64,
        /// Duration, s.
        for_s: f64,
    },
    /// The skin is warmer than usual, K.
    SkinOff(f64),
    /// A finger lies on the display from before the trial until it is told to lift.
    LiesOnDisplay,
    /// The participant does not touch.
    DoesNotTouch,
    /// The participant does not answer.
    DoesNotAnswer,
}

impl SimulatedEvent {
    /// Whether it belongs to an attempt at a trial.
    pub fn is_in(&self, trial: u32, attempt: u32) -> bool {
        self.trial == trial && self.attempt.is_none_or(|of| of == attempt)
    }
}

/// What the operator answers: goes on, but waits once for a skin that is not ready.
#[derive(Clone, Copy, Debug, Default)]
pub struct Operator {
    has_waited: bool,
}

impl Operator {
    /// A new trial begins.
    pub const fn begin_trial(&mut self) {
        self.has_waited = false;
    }

    /// The answer to a question.
    pub const fn decide(&mut self, question: &OperatorQuestion) -> Decision {
        match question {
            OperatorQuestion::SkinNotReady { .. } if !self.has_waited => {
                self.has_waited = true;
                Decision::Wait
            }
            _ => Decision::Continue,
        }
    }
}

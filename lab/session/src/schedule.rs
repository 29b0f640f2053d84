//! Which trial comes next: those of the plan, void ones once more at the end of their block, and no more of a staircase that
//! has finished.

use std::collections::VecDeque;

use experiment_statistics::staircase::Staircase;

use crate::record::TrialRecord;
use crate::{Plan, PlannedTrial, Session};

/// The trials that are still to come. It is a function of the plan and of the records so far, so an interrupted session goes on
/// where it was.
#[derive(Clone, Debug)]
pub struct Schedule<'a> {
    plan: &'a Plan,
    attempts_max: u32,
    /// Indices of the trials to come.
    queue: VecDeque<usize>,
    /// Number of attempts at each trial so far.
    attempts: Vec<u32>,
    /// Number of attempts at each trial in which nothing was presented.
    unpresented: Vec<u32>,
    staircases: Vec<Staircase>,
    /// Numbers of the trials that were void too many times.
    given_up: Vec<u32>,
}

/// Number of attempts without a presentation after which a trial is left out. They do not count towards `attempts_max`, so without this
/// limit a trial that can never be presented would be repeated for ever.
const UNPRESENTED_MAX: u32 = 10;

/// The next trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Next<'a> {
    /// The trial.
    pub trial: &'a PlannedTrial,
    /// Number of the attempt, from 1.
    pub attempt: u32,
    /// Level of its staircase, K.
    pub level_k: Option<f64>,
    /// Whether a break comes before it: its own, or that of a trial that was left out.
    pub break_before: bool,
}

impl<'a> Schedule<'a> {
    /// All trials of the plan.
    pub fn new(session: &Session, plan: &'a Plan) -> Self {
        Self {
            plan,
            attempts_max: session.voids.attempts_max,
            queue: (0..plan.trials.len()).collect(),
            attempts: vec![0; plan.trials.len()],
            unpresented: vec![0; plan.trials.len()],
            staircases: session.staircases.iter().map(|rule| rule.initial.clone()).collect(),
            given_up: Vec::new(),
        }
    }

    /// The trials that are left after these records, which an earlier run has made.
    ///
    /// # Errors
    /// A record is not that of the trial that came next: the records belong to another session, participant or seed.
    pub fn after(
        session: &Session,
        plan: &'a Plan,
        records: &[TrialRecord],
    ) -> Result<Self, OtherSession> {
        let mut schedule = Self::new(session, plan);
        for record in records {
            let expected = schedule.next_trial();
            let is_next = expected.is_some_and(|next| {
                (next.trial.number, next.attempt) == (record.trial, record.attempt)
                    && next.trial.levels == record.levels
            });
            if !is_next {
                return Err(OtherSession { trial: record.trial, attempt: record.attempt });
            }
            schedule.ended(record);
        }
        Ok(schedule)
    }

    /// The next trial, which is taken from those to come.
    pub fn next_trial(&mut self) -> Option<Next<'a>> {
        let mut break_before = false;
        loop {
            let index = self.queue.pop_front()?;
            let trial = &self.plan.trials[index];
            break_before |= trial.break_before && self.attempts[index] == 0;
            let staircase = trial.staircase.map(|staircase| &self.staircases[staircase]);
            if staircase.is_some_and(Staircase::is_finished) {
                continue;
            }
            self.attempts[index] += 1;
            return Some(Next {
                trial,
                attempt: self.attempts[index],
                level_k: staircase.map(Staircase::level),
                break_before,
            });
        }
    }

    /// Takes note of how the trial that came last has ended.
    pub fn ended(&mut self, record: &TrialRecord) {
        let Some(index) = self.plan.trials.iter().position(|trial| trial.number == record.trial)
        else {
            return;
        };
        let trial = &self.plan.trials[index];
        let unpresented = &mut self.unpresented[index];
        *unpresented += u32::from(!record.was_presented());
        let presented = record.attempt - *unpresented;
        if record.void.is_none() {
            if let (Some(staircase), Some(is_correct)) = (trial.staircase, record.is_correct) {
                self.staircases[staircase].answered(is_correct);
            }
        } else if presented < self.attempts_max && *unpresented < UNPRESENTED_MAX {
            let is_later = |other: &usize| self.plan.trials[*other].block != trial.block;
            let end_of_block = self.queue.iter().position(is_later).unwrap_or(self.queue.len());
            self.queue.insert(end_of_block, index);
        } else {
            self.given_up.push(trial.number);
        }
    }

    /// Numbers of the trials that were void too many times and are left out.
    pub fn given_up(&self) -> &[u32] {
        &self.given_up
    }
}

/// A record that does not belong to a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "trial {trial}, attempt {attempt}, is not what this session file, participant and seed plan at that place: the records \
     are those of another session"
)]
pub struct OtherSession {
    /// Number of the trial.
    pub trial: u32,
    /// Number of the attempt.
    pub attempt: u32,
}

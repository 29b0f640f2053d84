//! Adaptive staircase, n down and 1 up (Levitt, 1971), as a state machine that a session drives trial by trial.

use crate::Result;
use crate::error::checked;

/// Rule of a staircase. Levels are positive and change by a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaircaseRule {
    /// Level of the first trial, in the unit of the stimulus.
    pub start: f64,
    /// Smallest level; a step below it ends there.
    pub least: f64,
    /// Largest level; a step above it ends there.
    pub most: f64,
    /// Correct answers in a row after which the level falls: 1 converges to 50 % correct, 2 to 70.7 %, 3 to 79.4 %.
    pub correct_to_fall: u32,
    /// Factor of a step, above 1.
    pub factor: f64,
    /// Factor of a step before the reversal number [`coarse_reversals`](Self::coarse_reversals), above 1.
    pub coarse_factor: f64,
    /// Number of reversals from which `factor` holds; 0 for one factor throughout.
    pub coarse_reversals: usize,
    /// Reversals after which the staircase ends.
    pub reversals: usize,
    /// Last reversals whose geometric mean is the threshold.
    pub averaged: usize,
    /// Trials after which the staircase ends without enough reversals.
    pub trials_max: u32,
}

/// A staircase that runs or has ended. The same answers always lead to the same levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Staircase {
    rule: StaircaseRule,
    level: f64,
    trials: u32,
    correct_in_a_row: u32,
    last_step: Option<Direction>,
    reversals: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Down,
    Up,
}

impl Staircase {
    /// A staircase before its first trial.
    ///
    /// # Errors
    /// Levels that are not positive, finite and in order; a factor that is not above 1; no trials, no correct answers to fall;
    /// or no reversals to average, or more than the staircase has after the coarse ones.
    pub fn new(rule: StaircaseRule) -> Result<Self> {
        checked("least level", rule.least, "positive", |least| least > 0.0)?;
        checked("largest level", rule.most, "finite, and at least the least", |most| {
            most.is_finite() && most >= rule.least
        })?;
        checked("first level", rule.start, "between the least and the largest", |start| {
            (rule.least..=rule.most).contains(&start)
        })?;
        for (what, factor) in [("factor", rule.factor), ("coarse factor", rule.coarse_factor)] {
            checked(what, factor, "finite and above 1", |factor| {
                factor > 1.0 && factor.is_finite()
            })?;
        }
        let to_fall = f64::from(rule.correct_to_fall);
        checked("correct answers to fall", to_fall, "at least 1", |n| n >= 1.0)?;
        checked("trials", f64::from(rule.trials_max), "at least 1", |n| n >= 1.0)?;
        let fine = rule.reversals.saturating_sub(rule.coarse_reversals);
        let allowed = "from 1 to the reversals less the coarse ones";
        checked("averaged reversals", rule.averaged as f64, allowed, |_| {
            (1..=fine).contains(&rule.averaged)
        })?;
        Ok(Self {
            level: rule.start,
            rule,
            trials: 0,
            correct_in_a_row: 0,
            last_step: None,
            reversals: Vec::new(),
        })
    }

    /// Level of the next trial; after the end that of the trial that would follow.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Takes the answer of a trial at [`level`](Self::level). Answers after the end change nothing.
    pub fn answered(&mut self, correct: bool) {
        if self.is_finished() {
            return;
        }
        self.trials += 1;
        if !correct {
            self.correct_in_a_row = 0;
            self.step(Direction::Up);
            return;
        }
        self.correct_in_a_row += 1;
        if self.correct_in_a_row == self.rule.correct_to_fall {
            self.correct_in_a_row = 0;
            self.step(Direction::Down);
        }
    }

    /// Whether there are enough reversals, or as many trials as are allowed.
    pub fn is_finished(&self) -> bool {
        self.reversals.len() >= self.rule.reversals || self.trials >= self.rule.trials_max
    }

    /// Geometric mean of the last reversals, in the unit of the level. `None` while the staircase runs, and where it ended
    /// without enough reversals.
    pub fn threshold(&self) -> Option<f64> {
        if self.reversals.len() < self.rule.reversals {
            return None;
        }
        let last = &self.reversals[self.reversals.len() - self.rule.averaged..];
        let logarithms: f64 = last.iter().map(|level| level.ln()).sum();
        Some((logarithms / self.rule.averaged as f64).exp())
    }

    /// Levels at which the direction changed so far.
    pub fn reversals(&self) -> &[f64] {
        &self.reversals
    }

    /// Number of answers so far.
    pub fn trials(&self) -> u32 {
        self.trials
    }

    /// The rule.
    pub fn rule(&self) -> &StaircaseRule {
        &self.rule
    }

    fn step(&mut self, direction: Direction) {
        if self.last_step.is_some_and(|last| last != direction) {
            self.reversals.push(self.level);
        }
        self.last_step = Some(direction);
        let factor = if self.reversals.len() < self.rule.coarse_reversals {
            self.rule.coarse_factor
        } else {
            self.rule.factor
        };
        let level = match direction {
            Direction::Down => self.level / factor,
            Direction::Up => self.level * factor,
        };
        self.level = level.clamp(self.rule.least, self.rule.most);
    }
}

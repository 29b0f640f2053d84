//! The trials of a session in their order: a pure function of session file, participant and seed.

use serde::{Deserialize, Serialize};

use crate::Session;

/// All trials of a session for one participant.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Names of the factors, in the order of [`PlannedTrial::levels`].
    pub factors: Vec<String>,
    /// The trials in their order.
    pub trials: Vec<PlannedTrial>,
}

/// A trial of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// Its number, from 1.
    pub number: u32,
    /// Name of its part of the session.
    pub part: String,
    /// Number of its block, from 1 through the whole session.
    pub block: u32,
    /// Whether a break comes before it.
    pub break_before: bool,
    /// Level of each factor, as the session file writes it; empty if a staircase decides it or the part does not have it.
    pub levels: Vec<String>,
    /// What each station presents, in the order of the stations.
    pub presented: Vec<Presented>,
    /// Index of the staircase that decides the level; the trial is left out when that has finished.
    pub staircase: Option<usize>,
    /// Force to be followed, N.
    pub target_force_n: Option<f64>,
    /// The correct answer, if there is one.
    pub correct: Option<String>,
}

/// What a station presents in a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Presented {
    /// Nothing: no finger goes there.
    Nothing,
    /// A sample of a material, at room temperature.
    Sample {
        /// Name of the material.
        material: String,
    },
    /// The display, as an object of a material.
    Material {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Name of the material.
        material: String,
    },
    /// The display at a constant temperature.
    Hold {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Temperature, °C.
        celsius: f64,
    },
    /// The display at a base temperature, from which it departs in one of two intervals or in both.
    Pulses {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Temperature between the intervals, °C.
        base_c: f64,
        /// Departure in each interval, K.
        departures_k: [Departure; 2],
        /// Rate of departure and return, K/s.
        rate_k_s: f64,
    },
}

/// Departure from the base temperature in an interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Departure {
    /// This one, K.
    Fixed(f64),
    /// This one plus the level of the staircase times its sign, K: `Staircase { standard_k, sign }`.
    Staircase {
        /// Departure at level 0, K.
        standard_k: f64,
        /// -1 for cooling, 1 for warming.
        sign: f64,
    },
}

impl Plan {
    /// The trials for a participant, a code of letters and digits, and a seed.
    ///
    /// # Errors
    /// A constraint of the session that no order of the trials fulfils.
    pub fn new(session: &Session, participant: &str, seed: u64) -> Result<Self, PlanError> {
        todo!("{session:?} {participant} {seed}")
    }

    pub fn csv(&self, session: &Session) -> String {
        todo!("{session:?}")
    }

    /// The level of a factor in a trial; `None` if there is no such factor.
    #[must_use]
    pub fn level<'a>(&self, trial: &'a PlannedTrial, factor: &str) -> Option<&'a str> {
        let index = self.factors.iter().position(|name| name == factor)?;
        trial.levels.get(index).map(String::as_str)
    }
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no order of the trials fulfils {constraint} in {attempts} attempts")]
pub struct PlanError {
    /// The constraint by its key in the session file.
    pub constraint: String,
    /// Number of random orders that were tried.
    pub attempts: u32,
}

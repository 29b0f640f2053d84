//! What is recorded of a trial.

use serde::{Deserialize, Serialize};

/// Everything that a trial has given, in one line of the session's log. Times are seconds of the session's clock, which begins
/// with the session; what did not happen or is not known is `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrialRecord {
    /// Number of the trial in the plan, from 1.
    pub trial: u32,
    /// Number of the attempt, from 1.
    pub attempt: u32,
    /// Why its data do not count; `None` if they do.
    pub void: Option<String>,
    /// Name of the part of the session.
    pub part: String,
    /// Number of the block, from 1.
    pub block: u32,
    /// Level of each factor, in the order of the plan.
    pub levels: Vec<String>,
    /// Level of the staircase, K.
    pub staircase_level_k: Option<f64>,
    /// Begin of the trial.
    pub begin_s: f64,
    /// Tone to move above the stimuli.
    pub reach_cue_s: Option<f64>,
    /// Tone to touch, or that of the first interval.
    pub touch_cue_s: Option<f64>,
    /// First landing on a display, or the tone to touch where no display tells.
    pub land_s: Option<f64>,
    /// Last lift.
    pub lift_s: Option<f64>,
    /// The answer.
    pub answer_s: Option<f64>,
    /// End of the trial.
    pub end_s: f64,
    /// Number of landings on the display that was touched most often.
    pub touches: u32,
    /// Time in contact with it, s.
    pub contact_s: Option<f64>,
    /// Target of the force, N.
    pub target_force_n: Option<f64>,
    /// The answer: a word, or numbers of the stations joined by `;`.
    pub answer: Option<String>,
    /// The correct answer.
    pub expected: Option<String>,
    /// Whether the answer is the correct one.
    pub is_correct: Option<bool>,
    /// Room thermistor at the landing, °C.
    pub room_c: Option<f64>,
    /// What was measured at each station, in their order.
    pub stations: Vec<StationRecord>,
}

impl TrialRecord {
    /// Whether the participant was told to touch. Before that nothing is presented, so an attempt that ends then is not one of those that
    /// a trial has.
    pub const fn was_presented(&self) -> bool {
        self.touch_cue_s.is_some()
    }
}

/// What display and skin thermistor have measured of the finger at a station; all is `None` for a station without them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StationRecord {
    /// What was presented, in words.
    pub presented: String,
    /// First landing; the tone to touch on a sample, where nothing tells.
    pub land_s: Option<f64>,
    /// Skin thermistor, mean of the last 0.5 s before the landing, °C.
    pub skin_before_c: Option<f64>,
    /// By how much the skin thermistor fell until the last 0.5 s of the contact, K.
    pub skin_fall_k: Option<f64>,
    /// Set-point at the landing, °C.
    pub setpoint_c: Option<f64>,
    /// Display thermistor at the landing, °C.
    pub display_c: Option<f64>,
    /// Mean force from the first landing to the last lift or the tone to lift, N; gaps between touches count.
    pub force_mean_n: Option<f64>,
    /// Standard deviation of the force over the same time, N.
    pub force_sd_n: Option<f64>,
    /// Mean force of the last 2 s of the contact, N.
    pub force_end_mean_n: Option<f64>,
    /// Standard deviation of the force in the last 2 s of the contact, N.
    pub force_end_sd_n: Option<f64>,
    /// RMS distance of the force from its target from 2 s after the landing on, N.
    pub force_error_rms_n: Option<f64>,
    /// Time from the landing until the force stays within 10 % of its target, through the last 2 s before the tone to lift at least, s.
    pub force_settled_s: Option<f64>,
    /// Whether the set-point was limited or not followed at any time of the contact.
    pub is_limited: Option<bool>,
}

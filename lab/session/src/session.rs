//! What a session file says, checked: everything that the plan and the executor need.

use experiment_statistics::staircase::Staircase;
use serde::{Deserialize, Serialize};
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;

/// A session, as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Title, for people.
    pub title: String,
    /// Short name of the task, of letters and digits only, such as `p5`; it names the recorded files.
    pub task: String,
    /// Where the experiment comes from.
    pub cite: String,
    /// What the participant reads before the first trial.
    pub instruction: String,
    /// How displays are set up; `None` if all stations present samples.
    pub device: Option<DeviceSetup>,
    /// Where the fingers go.
    pub stations: Vec<Station>,
    /// What must hold before a trial.
    pub rest: Option<Rest>,
    /// How a trial proceeds.
    pub trial: TrialRules,
    /// What the participant is asked after each contact; `None` if nothing.
    pub answer: Option<Answer>,
    /// Which trials there are and in which order.
    pub design: Design,
    /// Staircases, whose trials the plan numbers.
    pub staircases: Vec<NamedStaircase>,
    /// Shortest break between two blocks, s.
    pub break_s: f64,
    /// What makes a trial void.
    pub voids: VoidRules,
    /// How the session is scored.
    pub score: Score,
    /// The text of the file.
    pub text: String,
}

/// How the device is set up.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceSetup {
    /// Control law.
    pub law: Law,
    /// Contact model.
    pub mode: ContactModel,
    /// The finger that the device assumes.
    pub assumed_finger: AssumedFinger,
    /// Temperature of objects, °C; `None` for that of the room.
    pub object_c: Option<f64>,
    /// Skin that set-points assume, °C; `None` for that of the sensor.
    pub assumed_skin_c: Option<f64>,
    /// Interval of telemetry, ms.
    pub stream_ms: u32,
}

/// Where a finger goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Station {
    /// Its name, which answers and columns use.
    pub name: String,
    /// The participant's finger that goes there, in words.
    pub finger: String,
}

/// Where the fingers rest before a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestPlace {
    /// On a pad of their own.
    Pad,
    /// On the display, which holds the temperature of the gate.
    Display,
    /// In the air.
    Air,
}

/// What must hold before a trial: the skin is at a temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Where the fingers rest.
    pub place: RestPlace,
    /// Temperature of the skin, °C.
    pub skin_c: f64,
    /// Largest distance of the mean over a second, K.
    pub within_k: f64,
    /// How long it must hold, s.
    pub for_s: f64,
    /// Time after which the operator is asked, s.
    pub timeout_s: f64,
}

/// How the participant touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactRule {
    /// As the participant likes, with lifting and touching again.
    Free,
    /// Once, until the tone.
    Hold,
    /// Once, following the target force of the trial.
    Force,
}

/// What happens in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// The participant touches the stimuli after a tone.
    Touch {
        /// Time between the tone to move and the tone to touch, s.
        reach_s: f64,
        /// How the participant touches.
        contact: ContactRule,
        /// Longest contact, s; with [`ContactRule::Hold`] and [`ContactRule::Force`] its length.
        max_s: f64,
    },
    /// The fingers stay on the display, which departs from its base temperature in two intervals.
    Intervals {
        /// Length of an interval, s.
        interval_s: f64,
        /// Time between the intervals, s.
        gap_s: f64,
    },
}

/// How a trial proceeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialRules {
    /// What happens in it.
    pub procedure: Procedure,
    /// Longest time from the tone to the landing, s.
    pub land_s: f64,
    /// Longest time for an answer after the contact, s.
    pub answer_s: f64,
    /// Whether the participant is told whether the answer was correct.
    pub feedback: bool,
}

/// What the participant is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The question.
    pub ask: String,
    /// The answers that are allowed.
    pub kind: AnswerKind,
}

/// The answers that are allowed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnswerKind {
    /// One of these words.
    OneOf(Vec<String>),
    /// A number from the first to the second for each station.
    NumberPerStation(f64, f64),
}

/// What makes a trial void.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoidRules {
    /// Largest distance of the display from its set-point at landing, K.
    pub display_off_preset_k: f64,
    /// Largest force, N.
    pub force_max_n: f64,
    /// Shortest contact, s.
    pub contact_min_s: f64,
    /// Largest relative distance of the mean force of the last two seconds from the target.
    pub force_off_target: Option<f64>,
    /// Largest time between the landings of two fingers on displays, s.
    pub landings_apart_s: Option<f64>,
    /// Most attempts at one trial.
    pub attempts_max: u32,
}

/// Which answer is correct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CorrectAnswer {
    /// None.
    None,
    /// The station whose material has the largest effusivity; none if they are equal.
    ColderStation,
    /// The level of this factor.
    Factor(String),
    /// `same` or `different`, by the materials of the stations.
    Same,
}

/// How a session is scored.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Which answer is correct.
    pub correct: CorrectAnswer,
    /// Proportion correct by chance.
    pub chance: Option<f64>,
    /// Proportion correct that counts as told apart.
    pub threshold: Option<f64>,
    /// Tables and tests of the analysis, by name.
    pub analyses: Vec<String>,
}

/// A staircase, whose level follows the answers.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedStaircase {
    /// Its name.
    pub name: String,
    /// The staircase before its first trial; its levels are K.
    pub initial: Staircase,
}

/// Which trials there are and in which order.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {}

impl Session {
    pub fn parse(text: &str, path: &std::path::Path) -> Result<Self, std::io::Error> {
        todo!("{text} {path:?}")
    }
    pub fn custom_material(&self, name: &str) -> Option<contact_model::material::Material> {
        todo!("{name}")
    }
}

//! The participant and the operator, as the executor sees them: it informs them, and asks what they have pressed.

use serde::{Deserialize, Serialize};
use thermal_client::client::{ReceivedEvent, ReceivedTelemetry};

use crate::PlannedTrial;

/// The participant and the operator of a session: persons at a window or a terminal, or their simulation.
///
/// The executor calls [`inform`](Self::inform) whenever something has changed, and [`response`](Self::response) and
/// [`decision`](Self::decision) at least every 20 ms. None of them may wait.
pub trait People {
    /// Takes note of what happens.
    fn inform(&mut self, update: &Update);

    /// The participant's response since the last call, if there is one.
    fn response(&mut self) -> Option<Response>;

    /// The operator's decision since the last call, if there is one.
    fn decision(&mut self) -> Option<Decision>;
}

/// What the participant and the operator are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    /// A trial begins: the trial, the number of its attempt from 1, and how many trials the plan has.
    Trial {
        /// The trial.
        trial: PlannedTrial,
        /// Number of the attempt, from 1.
        attempt: u32,
        /// Number of trials of the plan.
        of: usize,
    },
    /// The session is in this phase now.
    Phase(Phase),
    /// A tone for the participant.
    Cue(Cue),
    /// A text for the participant, without a question.
    Instruction(String),
    /// The participant is to answer.
    Ask(Question),
    /// The participant's question is over: answered, or too late.
    Answered(Option<Response>),
    /// The operator is to decide.
    Decide(OperatorQuestion),
    /// The operator's question is over: this was decided.
    Decided(Decision),
    /// The force that the participant is to follow, N; `None` from the end of the contact on.
    TargetForce(Option<f64>),
    /// Whether the answer was correct, for the participant.
    Feedback {
        /// Whether it was.
        is_correct: bool,
    },
    /// A line of telemetry.
    #[serde(skip)]
    Telemetry(ReceivedTelemetry),
    /// An event of the device.
    #[serde(skip)]
    Event(ReceivedEvent),
    /// The trial has ended; the reason if it is void.
    TrialEnded {
        /// Why its data do not count.
        void: Option<String>,
    },
    /// Something that the operator should know, and what to do about it.
    Notice(String),
    /// The session has ended: completed, or why not.
    Ended(Option<String>),
}

/// Phases of a session, in the order of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// The device is asked who it is, and set up.
    Connect,
    /// The skin returns to its temperature before contact, and the stimuli are placed.
    Rest,
    /// The display goes to its preset.
    Prepare,
    /// The participant moves the fingers above the stimuli.
    Reach,
    /// The participant touches the stimuli.
    Contact,
    /// The participant answers, without contact.
    Respond,
    /// The participant lifts the fingers.
    Return,
    /// A break between two blocks.
    Break,
    /// All trials have ended.
    End,
}

impl Phase {
    /// Its word in files and on screens.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Connect => "connect",
            Self::Rest => "rest",
            Self::Prepare => "prepare",
            Self::Reach => "reach",
            Self::Contact => "contact",
            Self::Respond => "respond",
            Self::Return => "return",
            Self::Break => "break",
            Self::End => "end",
        }
    }
}

/// Tones for the participant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cue {
    /// Move the fingers above the stimuli: 880 Hz.
    Reach,
    /// Touch: 1320 Hz.
    Touch,
    /// Interval of a trial with intervals, from 0 on: 1320 Hz.
    Interval(u8),
    /// Lift the fingers: 440 Hz.
    Lift,
}

impl Cue {
    /// Frequency of the tone, Hz; each lasts 0.2 s.
    pub const fn frequency_hz(self) -> u32 {
        match self {
            Self::Reach => 880,
            Self::Touch | Self::Interval(_) => 1320,
            Self::Lift => 440,
        }
    }
}

/// What the participant is asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Question {
    /// The text.
    pub ask: String,
    /// The answers.
    pub kind: crate::AnswerKind,
}

/// What the participant answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Response {
    /// The answer with this index, from 0 on.
    Choice(usize),
    /// A number for each station, in the order of the stations.
    Numbers(Vec<f64>),
}

/// What the operator is asked. Each has an answer [`Decision`]; [`Decision::Stop`] always ends the session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OperatorQuestion {
    /// Is the participant ready, and is everything that this text names in place? Answered by [`Decision::Continue`].
    Ready(String),
    /// The skin is not at its temperature after the time that the session allows: go on, wait, or leave the trial void?
    SkinNotReady {
        /// Mean of the skin over the last second, °C; `None` if the device does not know it.
        skin_c: Option<f64>,
        /// Temperature of the gate, °C.
        wanted_c: f64,
    },
    /// The device has tripped with this fault, which is explained with what to do: try to clear it and go on?
    Tripped {
        /// Word of the fault.
        fault: String,
        /// What it means and what to do.
        explanation: String,
    },
    /// The break is over: go on?
    BreakOver,
}

/// What the operator decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decision {
    /// Go on: everything is ready, in spite of the gate, or after clearing a fault.
    Continue,
    /// Wait once more for the skin.
    Wait,
    /// The trial does not count.
    Void,
    /// End the session; the bridge is switched off.
    Stop,
}

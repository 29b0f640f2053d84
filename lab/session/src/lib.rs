#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod people;
mod plan;
mod presented;
mod session;

pub use people::{Cue, Decision, OperatorQuestion, People, Phase, Question, Response, Update};
pub use plan::{Departure, Plan, PlanError, PlannedTrial, Presented};
pub use session::{
    Answer, AnswerKind, ContactRule, CorrectAnswer, Design, DeviceSetup, Procedure, Rest,
    RestPlace, Score, Session, StaircaseRule, Station, TrialRules, VoidRules,
};

#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod dataset;
mod executor;
pub mod measure;
mod people;
mod plan;
mod presented;
pub mod record;
mod schedule;
mod session;

pub use executor::{Executor, SessionEnd};
pub use schedule::{Next, OtherSession, Schedule};

pub use people::{Cue, Decision, OperatorQuestion, People, Phase, Question, Response, Update};
pub use plan::{Departure, Plan, PlanError, PlannedTrial, Presented};
pub use session::{
    Answer, AnswerKind, ContactRule, CorrectAnswer, Design, DeviceSetup, NamedStaircase, Procedure,
    Rest, RestPlace, Score, Session, Station, TrialRules, VoidRules,
};

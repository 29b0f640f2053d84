#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod design;
mod file;
mod people;
mod plan;
mod random;
mod session;

pub use design::{
    Blocks, Design, Factor, MaterialOf, Pairs, Part, Present, PresentCase, Pulses, Stimulus,
};
pub use file::SessionError;
pub use people::{Cue, Decision, OperatorQuestion, People, Phase, Question, Response, Update};
pub use plan::{Departure, Plan, PlanError, PlannedTrial, Presented};
pub use session::{
    ANALYSES, Answer, AnswerKind, ContactRule, CorrectAnswer, DeviceSetup, PUBLISHED_TABLES,
    Procedure, Quantity, Rest, RestPlace, Score, Session, StaircaseRule, Station, TrialRules,
    VoidRules,
};

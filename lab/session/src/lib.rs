#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod dataset;
mod design;
mod executor;
mod file;
pub mod measure;
mod people;
mod plan;
mod planned_dose;
mod presented;
mod random;
pub mod record;
mod schedule;
mod session;

pub use design::{
    Blocks, Design, Factor, MaterialOf, Pairs, Part, Present, PresentCase, Pulses, Stimulus,
};
pub use executor::{Executor, SessionEnd, check_device};
pub use file::SessionError;
pub use people::{Cue, Decision, OperatorQuestion, People, Phase, Question, Response, Update};
pub use plan::{Departure, Plan, PlanError, PlannedTrial, Presented, check_participant};
pub use planned_dose::DoseReached;
pub use schedule::{Next, OtherSession, Schedule};
pub use session::{
    ANALYSES, Answer, AnswerKind, ContactRule, CorrectAnswer, DeviceSetup, PUBLISHED_TABLES,
    Procedure, Quantity, Rest, RestPlace, Score, Session, StaircaseRule, Station, TrialRules,
    VoidRules, skin_sensors,
};

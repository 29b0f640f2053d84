//! Fault injection: single faults in many scenes at many times, random campaigns, pairs of faults and bit flips.
//!
//! ```text
//! fault cases (fault, symptoms, expected reaction)  x  scenes and times
//!        -> scene with the fault in it -> device (image or native) -> trace and answers
//!        -> first symptom in the true state of the plant, end of the current, reported cause -> assessment
//! ```
//!
//! [The list](fault_cases) states for each fault, before any run, which deviation of the plant makes it detectable and which
//! trip causes are then correct. [`RunAssessment`] checks every run: skin between 13 and 45 °C, less than a minute of CEM43,
//! no current later than 50 ms after the first symptom, a correct cause, no trip before the fault, and an unchanged set-point
//! after lines that may change nothing. A part of the list is run on [five fingers](five_finger_cases), too, of which those
//! without the fault must render as before.

mod assessment;
mod drawn_course;
mod drawn_device;
mod fault_case;
mod fault_run;
mod fault_scene;
mod five_fingers;
mod flips;
mod list;
mod matrix;
mod normal_use;
mod page;
mod pairs;
mod random_campaign;
mod scene_text;
mod sound_campaign;
mod strict;
mod symptom;
mod table;
mod touch;

pub use assessment::{Breach, RunAssessment};
pub use drawn_device::DrawnDevice;
pub use fault_case::{ExpectedReaction, FaultCase, InjectedFault, LearningExpected};
pub use fault_run::FaultRun;
pub use fault_scene::{FaultScene, InjectionPoint};
pub use five_fingers::{FiveFingerRun, Reference, five_finger_cases};
pub use flips::{
    BitFlip, FlipEffect, FlipRegion, FlipResult, FlippableMemory, ReferenceRun, flip_table,
};
pub use list::fault_cases;
pub use matrix::{FaultSummary, MatrixPlan, MatrixRun};
pub use normal_use::{SessionResult, UseSession, session_table};
pub use page::{HTML, page};
pub use pairs::{FaultPair, PairResult, pair_table, pairs};
pub use random_campaign::{CampaignResult, RandomCampaign, campaign_summary};
pub use sound_campaign::{SoundCampaign, SoundResult, sound_table};
pub use strict::Strict;
pub use symptom::Symptom;
pub use table::table;
pub use touch::Touch;

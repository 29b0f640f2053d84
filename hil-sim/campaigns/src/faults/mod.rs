//! The fault-injection matrix: every single fault, in many scenes, at many moments.
//!
//! ```text
//! list of fault_cases (fault, symptoms, reasons)  x  scenes (scene, moments)
//!        -> scene with the fault in it -> device (image or native) -> trace and answers
//!        -> when a sign is reached in the plant's truth, when the current ends, what the device says  -> assessment
//! ```
//!
//! What counts is laid down in [the list](fault_cases) before anything runs: which deviation of the plant makes a fault
//! detectable, and which words of the device are then right. What every run is held to is in [`RunAssessment`]: the skin
//! within 13 to 45 °C, less than a minute of CEM43, no current from 50 ms after the first sign on, a right reason, and no
//! trip before the fault.

mod assessment;
mod fault_case;
mod fault_run;
mod fault_scene;
mod flips;
mod list;
mod matrix;
mod normal_use;
mod page;
mod pairs;
mod random_campaign;
mod scene_text;
mod symptom;
mod table;

pub use assessment::{Breach, RunAssessment};
pub use fault_case::{ExpectedReaction, FaultCase, InjectedFault};
pub use fault_run::FaultRun;
pub use fault_scene::{FaultScene, InjectionPoint};
pub use flips::{
    BitFlip, FlipEffect, FlipRegion, FlipResult, FlippableMemory, ReferenceRun, flip_table,
};
pub use list::fault_cases;
pub use matrix::{FaultSummary, MatrixPlan};
pub use normal_use::{SessionResult, UseSession, session_table};
pub use page::{HTML, page};
pub use pairs::{FaultPair, PairResult, pair_table, pairs};
pub use random_campaign::{CampaignResult, RandomCampaign, campaign_summary};
pub use symptom::Symptom;
pub use table::table;

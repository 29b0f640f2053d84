#![doc = include_str!("../README.md")]

pub mod faults;
pub mod fidelity;
mod identification_survey;
mod parallel;
mod percentile;
pub mod tracking;

pub use identification_survey::{
    IdentificationResult, QUANTITIES, survey_device, table as survey_table,
};
pub use parallel::parallel_map;
pub use percentile::percentile;

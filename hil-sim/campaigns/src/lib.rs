#![doc = include_str!("../README.md")]

pub mod faults;
pub mod fidelity;
mod percentile;
mod survey;
mod work;

pub use percentile::percentile;
pub use survey::{QUANTITIES, Surveyed, survey, table as survey_table};
pub use work::map;

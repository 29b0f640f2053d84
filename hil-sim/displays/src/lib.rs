#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod closed_form;
mod comparison;
mod display;
mod ideal_tile;
mod layered_finger;
mod rc_ladder;
mod recording;
mod report;
mod touch;

pub use comparison::{Comparison, Description, Report, Tissue, scene};
pub use display::{Display, Showing, YAMAMOTO_RAMP_S};
pub use ideal_tile::skin_on_ideal_tile;
pub use rc_ladder::RcLadder;
pub use report::{chart, page, table};
pub use touch::{NoSingleContact, SingleContact};

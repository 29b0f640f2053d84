#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod bench_operator;
pub mod bring_up;
pub mod contact;
pub mod enrolment;
pub mod link;
pub mod step_screen;
pub mod terminal_people;
pub mod watched;

pub use thermal_client::{client, commissioning};

#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod client;
pub mod commissioning;
pub mod course;
mod fault_words;
pub mod link;
pub mod text;

pub use fault_words::{FaultWords, fault_words};

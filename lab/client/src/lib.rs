#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod client;
pub mod commissioning;
pub mod course;
pub mod link;

#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub use thermal_client::{client, commissioning, link};

#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod bench;
pub mod device;
pub mod falls;
pub mod hand;
pub mod observer;
pub mod operator;
pub mod participant;
pub mod predictions;
mod random;

pub use bench::{Bench, BenchError, BenchLink, BenchOptions, BenchPeople, Observation};
pub use hand::HandParams;
pub use observer::ObserverParams;
pub use operator::{Happening, SimulatedEvent};
pub use participant::{Participant, SkinParams};

#![doc = include_str!("../README.md")]

mod cells;
pub mod commission;
mod device;
pub mod dose;
pub mod engine;
pub mod hand;
pub mod host;
pub mod metrics;
pub mod processor;
mod recording;
pub mod report;
pub mod run;
pub mod scene;
pub mod telemetry;
pub mod trace;
mod world;

pub use cells::Cells;
pub use device::{Device, NativeDevice, RamLayout, run_on};
pub use world::{World, WorldError};

#![doc = include_str!("../README.md")]

#[macro_use]
mod named_enum;

pub mod board;
pub mod commissioning;
pub mod dose;
pub mod engine;
mod failure;
pub mod five_fingers;
mod flash_cells;
pub mod host;
pub mod metrics;
pub mod play;
pub mod processor;
pub mod report;
pub mod run;
mod runner;
pub mod scene;
mod scene_recording;
pub mod serve;
pub mod simulated_link;
pub mod speed;
pub mod trace;
pub mod trigger_edges;
pub mod upload;
mod world;

pub use failure::Failure;
pub use flash_cells::FlashCells;
pub use runner::{NativeRunner, RamLayout, SceneRunner, run_scene_on};
pub use world::{World, WorldError};

#![doc = include_str!("../README.md")]

pub mod allowed;
pub mod compiler;
pub mod float;
pub mod flow;
pub mod graph;
pub mod image;
pub mod levels;
pub mod location;
pub mod loops;
pub mod measure;
pub mod names;
pub mod panics;
mod proof;
mod scenes;
pub mod stack;
pub mod thumb;

pub use proof::{Proof, Section};

//! The code that the benchmark measures on the host and on the emulated microcontroller: [`kernels`] that compute
//! `E = erfcx(sqrt(n K))`, [`scenes`] for the whole model, and their [`inputs`].
//!
//! The peers are written after the cited formulas; their coefficients are derived by `build.rs`.
#![no_std]

pub mod inputs;
pub mod job;
pub mod kernels;
pub mod scenes;

#![doc = include_str!("../README.md")]
#![no_std]

pub mod inputs;
pub mod job;
pub mod kernels;
pub mod scenes;

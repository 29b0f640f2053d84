//! The hardware-free half of a Peltier thermal display: one [`Station`] per finger.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod drive;
pub mod protocol;
pub mod sense;
pub mod settings;
mod station;

pub use station::Station;

/// Control ticks per second.
pub const TICK_HZ: u32 = 1000;

//! The hardware-free half of a Peltier thermal display: one [`Station`] per finger, together a [`Hand`].
//!
//! [`Station::step`] is the product: a pure function of the station and one tick's [`sense::Samples`], without
//! hardware, clock, allocation or global state. All of it is integer arithmetic, so nothing in the control
//! path can be NaN, and it computes the same bits on the microcontroller and on the host. `f64` is used where
//! settings and materials are turned into integers, once each.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod commission;
pub mod control;
pub mod drive;
pub mod guard;
mod hand;
mod hold;
pub mod protocol;
pub mod render;
pub mod sense;
pub mod settings;
mod station;

pub use guard::State;
pub use hand::Hand;
pub use station::Station;

/// Control ticks per second.
pub const TICK_HZ: u32 = 1000;

/// Scans of all channels per second.
pub const SCANS_PER_SECOND: u32 = TICK_HZ * sense::SCANS_PER_TICK as u32;

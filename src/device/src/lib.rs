//! The hardware-free half of a Peltier thermal display: one [`Station`] per finger, together a [`Device`].
//!
//! [`Station::step`] is the product: a pure function of the station and one tick's [`sense::Samples`], without
//! hardware, clock, allocation or global state. All of it is integer arithmetic, so nothing in the control
//! path can be NaN, and it computes the same bits on the microcontroller and on the host. `f64` is used where
//! settings and materials are turned into integers, once each.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod command;
pub mod control;
mod device;
pub mod drive;
mod hold;
pub mod identification;
pub mod reference;
pub mod safety;
pub mod sense;
mod station;
mod telemetry;

pub use device::Device;
pub use safety::State;
pub use station::Station;
pub use telemetry::Telemetry;
pub use thermal_settings::TICK_HZ;

/// Scans of all channels per second.
pub const SCANS_PER_SECOND: u32 = TICK_HZ * sense::SCANS_PER_TICK as u32;

//! The hardware-free half of the thermal display's firmware.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bridge;
pub mod mailbox;
pub mod task_liveness;

pub use thermal_commissioning as commissioning;
pub use thermal_device as device;
pub use thermal_protocol as protocol;
pub use thermal_settings as settings;

#[cfg(test)]
mod tests;

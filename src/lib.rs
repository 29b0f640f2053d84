//! The hardware-free half of the firmware of a Peltier thermal display: a tile that feels like
//! copper, granite, ABS or foam to the finger on it.
//!
//! Start at [`Station::step`](device::Station::step): one control tick of one finger, from the
//! counts of thermistors, force and current to the command of the bridge, as a straight line of
//! stages.
//!
//! ```text
//! samples -> sense -> detect faults -> estimate -> reference -> control -> actuate -> outputs
//! ```
//!
//! | module | purpose |
//! |---|---|
//! | [`device`] | [`Device`](device::Device), the stations of all fingers, with everything that a control tick does |
//! | [`learner`] | estimates the finger that touches from the heat flux, in a task of its own |
//! | [`settings`] | what differs between two built devices, and how it is stored in flash |
//! | [`commissioning`] | calibration of the thermistors and identification of the tile, in the task that answers the host |
//! | [`wire`] | what host and device say to each other, declared once |
//! | [`protocol`] | the lines between host and device |
//! | [`bridge`] | driver of an H-bridge with two logic inputs and an enable input |
//! | [`line_queue`] | the queue of received lines, between the interrupt and the task that answers |
//! | [`task_liveness`] | feeds the independent watchdog only while every task runs |
//!
//! The contact model behind the reference is the crate [`contact_model`]. The tasks are in
//! `src/main.rs`, pins, clocks and peripherals in `src/board/`. The same library runs on the
//! microcontroller, in the emulated microcontroller and natively in the simulator, bit for bit.
//! Nobody has run it on silicon yet.
//!
//! A station that is off drives nothing:
//!
//! ```
//! use thermal_display::device::drive::Drive;
//! use thermal_display::device::sense::Samples;
//! use thermal_display::device::{Device, FingerIndex};
//! use thermal_display::settings::Settings;
//!
//! let mut device = Device::<1>::new(&Settings::default());
//! let outputs = device.step_finger(FingerIndex::FIRST, &Samples::default());
//! assert_eq!(outputs.drive, Drive::Off);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bridge;
pub mod line_queue;
pub mod task_liveness;

pub use thermal_commissioning as commissioning;
pub use thermal_device as device;
pub use thermal_learner as learner;
pub use thermal_protocol as protocol;
pub use thermal_settings as settings;
pub use thermal_wire as wire;

#[cfg(test)]
mod tests;

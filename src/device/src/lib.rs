#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod bismuth_telluride;
pub mod command;
pub mod control;
mod device;
pub mod drive;
pub mod estimate;
pub mod events;
mod finger_index;
pub mod identification;
pub mod learning;
mod low_pass;
pub mod pi;
mod pwm_period;
pub mod reference;
pub mod safety;
pub mod sense;
mod state_name;
mod station;
pub mod stimulus;
mod telemetry;
mod trigger_edge;

pub use device::{Device, DeviceInPlace, execute_in_turn};
pub use finger_index::FingerIndex;
pub use pwm_period::{
    PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER, PWM_STEPS_PER_SECOND,
};
pub use state_name::StateName;
pub use station::Station;
pub use telemetry::{Telemetry, TelemetryFields};
pub use thermal_learner::Flux;
pub use thermal_settings::{TICK_HZ, TICK_S, Vocabulary};
pub use trigger_edge::TriggerEdge;

/// Scans of all eight analogue signals of one finger per second: 16 000, of which 16 are summed for each control tick.
pub const SCANS_PER_SECOND: u32 = TICK_HZ * sense::SCANS_PER_TICK as u32;

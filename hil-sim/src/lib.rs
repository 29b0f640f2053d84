//! Stand-in for the hardware of the thermal display: a simulated Peltier tile, finger and sensors
//! ([`plant`]), an emulated microcontroller that runs the release image ([`machine`]), and what runs scenes on
//! them.
//!
//! Links Unicorn (GPL-2.0); firmware and contact model do not.

pub mod commission;
pub mod dose;
pub mod engine;
pub mod faults;
pub mod fidelity;
pub mod firmware;
pub mod hand;
pub mod host;
pub mod infrared;
pub mod machine;
pub mod metrics;
pub mod plant;
pub mod report;
pub mod roughness;
pub mod run;
pub mod scene;
pub mod telemetry;
pub mod thesis;
pub mod trace;
mod world;

pub use world::{World, WorldError};

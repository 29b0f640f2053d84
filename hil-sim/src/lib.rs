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
pub mod machine;
pub mod metrics;
pub mod report;
pub mod run;
pub mod scene;
pub mod telemetry;
pub mod trace;
mod world;

pub use thermal_plant::{self as plant, infrared};
pub use thermal_thesis::{self as thesis, roughness};

pub use world::{World, WorldError};

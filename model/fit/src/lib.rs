#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod components;
pub mod fingers;
mod fit;
mod layers;
mod nonnegative;

pub use components::{Components, components};
pub use contact_model::slab::Back;
pub use fit::{Fit, fit};
pub use layers::{Layer, impedance};

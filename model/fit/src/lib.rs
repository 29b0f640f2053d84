#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod fingers;
mod fit;
mod layers;
mod nonnegative;
mod shapes;

pub use contact_model::slab::Back;
pub use fit::{Fit, fit};
pub use layers::{Layer, impedance};
pub use shapes::{Shapes, shapes};

//! The model in floating point: the yardstick of the fixed-point path, and what tools and set-up use.
//!
//! Generic over [`Real`], so that `f32` shows what single precision costs.

mod contact;
mod erfcx;
mod real;
mod semi_infinite;

pub use contact::{Contact, Response, contact_resistance, mean_conductance};
pub use erfcx::erfcx;
pub use real::Real;
pub use semi_infinite::{SemiInfinite, fourier_number, interface_temperature};

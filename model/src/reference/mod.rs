//! Contact model in floating point: reference for the fixed-point path, and for tools and set-up.
//!
//! Generic over [`Real`], so that the error of `f32` can be measured too.

mod contact;
mod erfcx;
mod real;
mod semi_infinite;

pub use contact::{Contact, Response, conductance_at_hardness, contact_resistance};
pub use erfcx::erfcx;
pub use real::Real;
pub use semi_infinite::{SemiInfinite, fourier_number, interface_temperature};

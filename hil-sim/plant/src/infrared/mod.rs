//! The thesis's infrared instrument (section 5.2): a camera that sees a fingertip through the window it touches
//! and a beamsplitter.
//!
//! ```text
//! target --[ window 1 ]--[ beamsplitter 2 ]-- camera      all of it in air of ambient temperature
//! ```
//!
//! Every body is grey within the camera's band, 7.5 to 13 µm. The camera turns the radiance that arrives,
//! `U_tot`, into the temperature of a black body of that radiance: the apparent temperature. [`Camera`] goes
//! from a target's true temperature to the apparent one, and back with Eq. 5-3 (Eq. 5-4 without optics).
//!
//! The air is clear over the thesis's 300 mm, and radiation that goes back and forth between window and
//! beamsplitter is neglected, both as in the thesis. That the camera sees itself in the window is neglected by
//! the thesis's way back but may be part of what is seen: [`SelfReflection`].

mod camera;
mod optics;
mod planck;
mod sight;

pub use camera::{Camera, CameraParams, ParameterError, Reading};
pub use optics::{BEAMSPLITTER, Bandpass, Optic};
pub use planck::{BAND_M, RANGE_C, radiance, radiance_per_k, temperature_c};
pub use sight::{LineOfSight, SKIN_EMISSIVITY, SelfReflection, Surroundings};

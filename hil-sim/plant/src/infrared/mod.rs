//! The thesis's infrared instrument (section 5.2): a camera that measures a fingertip through the window it touches and
//! a beamsplitter.
//!
//! ```text
//! target --[ window 1 ]--[ beamsplitter 2 ]-- camera      all of it in air of ambient temperature
//! ```
//!
//! Every body is grey within the camera's band, 7.5 to 13 µm. The camera converts the radiance it receives, `U_tot`, into
//! the temperature of a black body of the same radiance: the apparent temperature. [`Camera`] computes the apparent
//! temperature of a target, and recovers the true one from it by Eq. 5-3 (Eq. 5-4 without optics).
//!
//! As in the thesis, the air is transparent over its 300 mm, and multiple reflections between window and beamsplitter are
//! neglected. The thesis's inversion also neglects the reflection of the camera in the window, which can be simulated:
//! [`SelfReflection`].

mod camera;
mod optical_path;
mod optics;
mod planck;

pub use camera::{Camera, CameraParams, ParameterError, Reading};
pub use optical_path::{OpticalPath, SKIN_EMISSIVITY, SelfReflection, Surroundings};
pub use optics::{BEAMSPLITTER, Bandpass, Optic};
pub use planck::{BAND_M, RANGE_C, radiance, radiance_per_k, temperature_c};

//! Radiation transfer from target to camera (Eq. 5-3 and 5-4) and its inverse.

use super::{BEAMSPLITTER, Optic, radiance};

/// Emissivity of skin, and of the tape of the thesis's calibration (section 5.2.2).
pub const SKIN_EMISSIVITY: f64 = 0.95;

/// Temperatures of the bodies that radiate besides the target, deg C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Room.
    pub ambient_c: f64,
    /// Window; without effect if there is none.
    pub window_c: f64,
    /// Beamsplitter; without effect if there is none.
    pub splitter_c: f64,
}

impl Surroundings {
    /// Optics at room temperature, deg C.
    pub fn at(ambient_c: f64) -> Self {
        Self { ambient_c, window_c: ambient_c, splitter_c: ambient_c }
    }
}

/// Reflection of the camera's own warm body in the window.
///
/// The thesis names it as the reason for its overestimates through ZnS, with a camera of about 30 deg C, but omits it
/// from its model (section 5.2.5). Here the radiation of the camera passes the beamsplitter twice, to the window and back,
/// and replaces the same fraction of the ambient radiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfReflection {
    /// Temperature of the camera's body, deg C.
    pub camera_c: f64,
    /// Fraction of the reflected radiation that originates from the camera, 0 to 1.
    pub share: f64,
}

/// Linear relation of the radiance at the camera to that of the target: `U_tot = gain U_obj + offset`, in W/(m² sr).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalPath {
    gain: f64,
    offset: f64,
}

impl OpticalPath {
    /// Eq. 5-3, or 5-4 without optics, for a target of an emissivity in (0, 1] and surroundings within
    /// [`super::RANGE_C`].
    pub fn new(optic: Optic, emissivity: f64, surroundings: &Surroundings) -> Self {
        let ambient = radiance(surroundings.ambient_c);
        let Some(window) = optic.window() else {
            return Self { gain: emissivity, offset: (1.0 - emissivity) * ambient };
        };
        let past_splitter = BEAMSPLITTER.transmissivity;
        let past_both = window.transmissivity * past_splitter;
        Self {
            gain: emissivity * past_both,
            offset: ((1.0 - emissivity) * past_both
                + window.reflectivity * past_splitter
                + BEAMSPLITTER.reflectivity)
                * ambient
                + window.emissivity() * past_splitter * radiance(surroundings.window_c)
                + BEAMSPLITTER.emissivity() * radiance(surroundings.splitter_c),
        }
    }

    /// The same path with the reflection of the camera in the window, if there is one.
    pub fn with_self_reflection(
        self,
        optic: Optic,
        camera: &SelfReflection,
        ambient_c: f64,
    ) -> Self {
        let mirrored = optic.window().map_or(0.0, |window| {
            window.reflectivity * BEAMSPLITTER.transmissivity * BEAMSPLITTER.transmissivity
        });
        let excess = radiance(camera.camera_c) - radiance(ambient_c);
        Self { offset: self.offset + camera.share * mirrored * excess, ..self }
    }

    /// Radiance at the camera for a black-body radiance of the target's temperature.
    pub fn total_radiance(&self, target: f64) -> f64 {
        self.gain * target + self.offset
    }

    /// Black-body radiance of the target's temperature for a radiance at the camera.
    pub fn target_radiance(&self, total: f64) -> f64 {
        (total - self.offset) / self.gain
    }
}

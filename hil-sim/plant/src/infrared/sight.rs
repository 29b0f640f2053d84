//! The way from target to camera and back (Eq. 5-3 and 5-4).

use super::{BEAMSPLITTER, Optic, radiance};

/// Emissivity of skin, and of the tape that the thesis calibrated with (section 5.2.2).
pub const SKIN_EMISSIVITY: f64 = 0.95;

/// Temperatures of all that radiates besides the target, deg C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Room.
    pub ambient_c: f64,
    /// Window; without effect where there is none.
    pub window_c: f64,
    /// Beamsplitter; likewise.
    pub splitter_c: f64,
}

impl Surroundings {
    /// Optics as warm as the room, deg C.
    #[must_use]
    pub fn at(ambient_c: f64) -> Self {
        Self {
            ambient_c,
            window_c: ambient_c,
            splitter_c: ambient_c,
        }
    }
}

/// The camera sees its own warm body in the window.
///
/// The thesis names it as the reason why it overestimates through ZnS, with a camera of about 30 deg C, and
/// leaves it out of its model (section 5.2.5). Here the camera's radiation passes the beamsplitter on its way to
/// the window and again on its way back, and takes the place of as much ambient radiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfReflection {
    /// The camera's body, deg C.
    pub camera_c: f64,
    /// How much of what the window mirrors to the camera, past the beamsplitter, is the camera: 0 to 1.
    pub share: f64,
}

/// How the camera's signal depends on the target: `U_tot = gain U_obj + offset`, radiances in W/(m² sr).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOfSight {
    gain: f64,
    offset: f64,
}

impl LineOfSight {
    /// Eq. 5-3, or 5-4 without optics, for a target of an emissivity in (0, 1] and surroundings within
    /// [`super::RANGE_C`].
    #[must_use]
    pub fn new(optic: Optic, emissivity: f64, surroundings: &Surroundings) -> Self {
        let ambient = radiance(surroundings.ambient_c);
        let Some(window) = optic.window() else {
            return Self {
                gain: emissivity,
                offset: (1.0 - emissivity) * ambient,
            };
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

    /// The same with the camera seeing itself in the window, if there is one.
    #[must_use]
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
        Self {
            offset: self.offset + camera.share * mirrored * excess,
            ..self
        }
    }

    /// Radiance that arrives, from the black-body radiance of the target's temperature.
    #[must_use]
    pub fn total(&self, target: f64) -> f64 {
        self.gain * target + self.offset
    }

    /// Black-body radiance of the target's temperature, from the radiance that arrives.
    #[must_use]
    pub fn target(&self, total: f64) -> f64 {
        (total - self.offset) / self.gain
    }
}

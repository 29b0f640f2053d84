//! The object that the host has chosen.

use contact_model::fixed_point::{Celsius, ContactPair};
use contact_model::material::{MATERIALS, SKIN, Surface};

use crate::TICK_HZ;
use crate::reference::{Mode, Scene};

/// Material, temperature and model of the object.
#[derive(Clone, Debug)]
pub struct PresentedObject {
    /// Name of the material, and its pair with the finger.
    pub material: Option<(&'static str, ContactPair)>,
    /// Temperature before contact; `None` takes that of the room.
    pub temperature: Option<Celsius>,
    /// Model that gives the set-point.
    pub mode: Mode,
    /// Pair of the finger with any material: contact of skin and display does not depend on it.
    default_pair: Option<ContactPair>,
}

impl PresentedObject {
    /// No material is chosen yet. Computed in `f64`, for start-up.
    #[must_use]
    pub fn new(display: &Surface) -> Self {
        let [(_, any), ..] = &MATERIALS;
        Self {
            material: None,
            temperature: None,
            mode: Mode::default(),
            default_pair: ContactPair::new(&SKIN, any, display, 1.0 / f64::from(TICK_HZ)).ok(),
        }
    }

    /// The pair by which skin and display touch: that of the chosen material, or of any.
    #[must_use]
    pub fn pair_under_finger(&self) -> Option<&ContactPair> {
        let chosen = self.material.as_ref().map(|(_, pair)| pair);
        chosen.or(self.default_pair.as_ref())
    }

    /// What is presented; `None` before a material is chosen.
    #[must_use]
    pub fn scene(&self) -> Option<Scene<'_>> {
        let (_, pair) = self.material.as_ref()?;
        Some(Scene {
            pair,
            object: self.temperature,
            mode: self.mode,
        })
    }
}

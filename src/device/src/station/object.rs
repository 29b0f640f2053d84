//! The object that the host has chosen.

use contact_model::fixed_point::{Celsius, ContactPair};
use contact_model::material::{MATERIALS, SKIN, Surface};

use crate::TICK_HZ;
use crate::reference::{Mode, Scene};

/// What the host has chosen to present: the object's material and temperature, and the model that gives the set-point.
/// It is kept in every state, and `start` presents it.
#[derive(Clone, Debug)]
pub struct PresentedObject {
    /// Name of the chosen material, and the constants of its contact with the finger; `None` before the first choice.
    pub material: Option<(&'static str, ContactPair)>,
    /// Temperature of the object before contact, °C; `None` takes that of the room.
    pub temperature: Option<Celsius>,
    /// Model that gives the set-point: with contact resistance, or semi-infinite with perfect contact.
    pub mode: Mode,
    /// Contact constants with which the estimator computes the heat between skin and display until the host chooses a
    /// material. Built for the first material of the list; any would do, because the part for skin and display does not
    /// depend on the material. `None` if the display's surface in the settings is outside the domain of the contact model.
    default_pair: Option<ContactPair>,
}

impl PresentedObject {
    /// Nothing chosen yet: no material, the object at the room's temperature, the model with contact resistance.
    /// Computed in `f64` for this `display` surface, so it is for the start only.
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

    /// Constants by which the estimator computes the heat between skin and display: those of the chosen material, or
    /// before the choice of the first in the list, which are equal for skin and display. `None` only if the settings
    /// give none.
    #[must_use]
    pub fn contact_pair(&self) -> Option<&ContactPair> {
        let chosen = self.material.as_ref().map(|(_, pair)| pair);
        chosen.or(self.default_pair.as_ref())
    }

    /// What the reference generator presents in the states preset and contact; `None` before a material is chosen.
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

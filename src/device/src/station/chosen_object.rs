//! The object that the host has chosen to present.

use contact_model::fixed_point::{Body, Celsius};
use contact_model::material::{MATERIALS, Surface};

use crate::command::{AssumedFinger, ChosenMaterial};
use crate::estimate::Bodies;
use crate::reference::{ContactModel, PresentedObject};

/// What the host has chosen to present: material and temperature of the object, and the contact model that gives the
/// set-point. The choice is kept in every state, and `start` presents it.
#[derive(Clone, Debug)]
pub struct ChosenObject {
    /// The chosen material; `None` before the host has chosen one.
    pub material: Option<ChosenMaterial>,
    /// The object's body, if it is no half-space of its material.
    pub body: Option<Body>,
    /// The finger that is assumed for the one that touches.
    pub finger: AssumedFinger,
    /// Temperature of the object before contact, °C; `None` takes the room's temperature.
    pub temperature: Option<Celsius>,
    /// Contact model that gives the set-point while the object is presented: with contact resistance, or perfect
    /// contact of two semi-infinite bodies.
    pub mode: ContactModel,
    /// The first of [`MATERIALS`], for the time before the host chooses a material: it serves only to compute the heat
    /// flow between skin and display, for which all materials give the same result. `None` if the display's surface in
    /// the settings is outside of the domain of the contact model.
    default_material: Option<ChosenMaterial>,
}

impl ChosenObject {
    /// Nothing chosen yet: no material, the object at the room's temperature, the model with contact resistance.
    /// Computes the default contact constants for the display's surface in `f64`, so it is for the start only.
    #[must_use]
    pub fn new(display: &Surface) -> Self {
        let [(name, any), ..] = &MATERIALS;
        Self {
            material: None,
            body: None,
            finger: AssumedFinger::default(),
            temperature: None,
            mode: ContactModel::default(),
            default_material: ChosenMaterial::new(name, any, display).ok(),
        }
    }

    /// The chosen material or, before a choice, the first in [`MATERIALS`], from which the estimator computes the heat
    /// flow between skin and display; that part is the same for all materials. `None` if no material is chosen and the
    /// display's surface in the settings is outside of the domain of the contact model.
    #[must_use]
    pub fn material_or_default(&self) -> Option<&ChosenMaterial> {
        self.material.as_ref().or(self.default_material.as_ref())
    }

    /// The assumed finger and the object, unless both are half-spaces.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> Option<Bodies<'_>> {
        match (&self.body, &self.finger) {
            (None, AssumedFinger::Thesis(_)) => None,
            _ => self.chosen_bodies(),
        }
    }

    #[inline(never)]
    fn chosen_bodies(&self) -> Option<Bodies<'_>> {
        let object = match &self.body {
            Some(body) => body,
            None => &self.material_or_default()?.half_space,
        };
        Some(Bodies {
            finger: self.finger.body()?,
            object,
        })
    }

    /// Input of the reference generator, which computes set-point and target in the states preset and contact: contact
    /// constants, bodies, object temperature and contact model. `None` before a material is chosen.
    #[must_use]
    pub fn presented_object_if_chosen(&self) -> Option<PresentedObject<'_>> {
        Some(PresentedObject {
            pair: &self.material.as_ref()?.pair,
            bodies: self.bodies(),
            object: self.temperature,
            mode: self.mode,
        })
    }
}

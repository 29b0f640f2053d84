//! The object that the host has chosen to present.

use contact_model::fixed_point::{Body, Celsius, ContactPair, FingerBody, ScaledBody};
use contact_model::material::{MATERIALS, SKIN, Surface};
use fixed::types::U16F16;

use crate::TICK_S;
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
    /// Contact constants for the time before the host chooses a material: those of the first material in [`MATERIALS`].
    /// They serve only to compute the heat flow between skin and display, for which all materials give the same result.
    /// `None` if the display's surface in the settings is outside of the domain of the contact model.
    default_pair: Option<ContactPair>,
}

impl ChosenObject {
    /// Nothing chosen yet: no material, the object at the room's temperature, the model with contact resistance.
    /// Computes the default contact constants for the display's surface in `f64`, so it is for the start only.
    #[must_use]
    pub fn new(display: &Surface) -> Self {
        let [(_, any), ..] = &MATERIALS;
        Self {
            material: None,
            body: None,
            finger: AssumedFinger::default(),
            temperature: None,
            mode: ContactModel::default(),
            default_pair: ContactPair::new(&SKIN, any, display, TICK_S).ok(),
        }
    }

    /// Contact constants of skin, display and object, from which the estimator computes the heat flow between skin and
    /// display: those of the chosen material or, before a choice, those of the first material in [`MATERIALS`]. Their
    /// part for skin and display is the same for all materials. `None` if no material is chosen and the display's
    /// surface in the settings is outside of the domain of the contact model.
    #[must_use]
    pub fn contact_pair(&self) -> Option<&ContactPair> {
        let chosen = self.material.as_ref().map(|material| &material.pair);
        chosen.or(self.default_pair.as_ref())
    }

    /// The assumed finger and the object, unless both are half-spaces. Before a material is chosen, the object is the
    /// skin's half-space.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> Option<Bodies<'_>> {
        let object = match (&self.body, self.finger) {
            (None, AssumedFinger::Thesis) => return None,
            (Some(body), _) => ScaledBody {
                body,
                factor: U16F16::ONE,
            },
            (None, AssumedFinger::Mean | AssumedFinger::MeanOnPad) => ScaledBody {
                body: &FingerBody::THESIS.tissue,
                factor: (self.material.as_ref())
                    .map_or(U16F16::ONE, |material| material.impedance_ratio),
            },
        };
        Some(Bodies {
            finger: self.finger.body(),
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

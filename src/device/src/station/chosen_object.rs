//! The object that the host has chosen to present.

use contact_model::contact_law::ContactLaw;
use contact_model::fixed_point::{
    Body, Celsius, ContactPair, Fraction, OwnResistances, ScaledBody,
};
use contact_model::material::{MATERIALS, SKIN, Surface};
use fixed::types::{I4F28, U16F16};

use crate::TICK_S;
use crate::command::{AssumedFinger, ChosenContactLaw, ChosenMaterial, ObjectBody};
use crate::estimate::Bodies;
use crate::reference::{ContactModel, PresentedObject};

/// What the host has chosen to present: material and temperature of the object, and the contact model that gives the
/// set-point. The choice is kept in every state, and `start` presents it.
#[derive(Clone, Debug)]
pub struct ChosenObject {
    /// The chosen material; `None` before the host has chosen one.
    pub material: Option<ChosenMaterial>,
    /// The finger that is assumed for the one that touches.
    finger: AssumedFinger,
    /// The contact law that the host has set.
    pub contact_law: ContactLaw,
    /// Whether the object is the half-space of its material.
    is_half_space: bool,
    /// The word of the object's body in the protocol.
    pub body_name: &'static str,
    /// The assumed finger and the object as bodies. Before a material is chosen, the object is the skin's half-space.
    bodies: Bodies,
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

/// Contact constants of the first material on this display.
#[inline(never)]
fn default_pair(display: &Surface) -> Option<ContactPair> {
    let [(_, any), ..] = &MATERIALS;
    ContactPair::new(&SKIN, any, display, TICK_S).ok()
}

impl ChosenObject {
    /// Nothing chosen yet: no material, the default finger, the object at the room's temperature, the model with contact
    /// resistance.
    /// Computes the default contact constants for the display's surface in `f64`, so it is for the start only.
    pub fn new(display: &Surface, display_layer: U16F16) -> Self {
        let mut chosen = Self {
            material: None,
            finger: AssumedFinger::Thesis,
            contact_law: ContactLaw::NOMINAL,
            is_half_space: true,
            body_name: ObjectBody::HalfSpace.name(),
            bodies: Bodies::HALF_SPACES,
            temperature: None,
            mode: ContactModel::default(),
            default_pair: default_pair(display),
        };
        chosen.choose_finger(AssumedFinger::default());
        chosen.set_display_layer(display_layer);
        chosen
    }

    /// Contact constants of skin, display and object, from which the estimator computes the heat flow between skin and
    /// display: those of the chosen material or, before a choice, those of the first material in [`MATERIALS`]. Their
    /// part for skin and display is the same for all materials. `None` if no material is chosen and the display's
    /// surface in the settings is outside of the domain of the contact model.
    pub fn contact_pair(&self) -> Option<&ContactPair> {
        let chosen = self.material.as_ref().map(|material| &material.pair);
        chosen.or(self.default_pair.as_ref())
    }

    /// Presents the half-space of a material from now on.
    pub fn choose_material(&mut self, material: &ChosenMaterial) {
        self.material = Some(*material);
        self.choose_body(&ObjectBody::HalfSpace);
    }

    /// Presents an object with this body from now on.
    pub fn choose_body(&mut self, body: &ObjectBody) {
        self.body_name = body.name();
        let body = body.relaxations();
        let object = &mut self.bodies.object;
        match (body, &self.material) {
            (Some(body), _) => *object = ScaledBody { body: *body, factor: U16F16::ONE },
            // The half-spaces differ by their factor only; the body is not copied again, to save time.
            (None, Some(material)) if self.is_half_space => {
                object.factor = material.impedance_ratio
            }
            (None, Some(material)) => *object = ScaledBody::half_space(material.impedance_ratio),
            (None, None) => *object = ScaledBody::half_space(U16F16::ONE),
        }
        self.is_half_space = body.is_none();
        self.bodies.are_half_spaces = self.is_half_space && self.finger == AssumedFinger::Thesis;
    }

    /// The display has this surface; computes in `f64`. Before a material is chosen.
    pub fn set_display_surface(&mut self, display: &Surface) {
        self.default_pair = default_pair(display);
    }

    /// Uses these contact constants, of another surface of the display with the chosen material or, before a choice, with any.
    pub const fn replace_contact_pair(&mut self, pair: &ContactPair) {
        self.default_pair = Some(*pair);
        if let Some(material) = &mut self.material {
            material.pair = *pair;
        }
    }

    /// The display has a layer of this resistance on its face: its temperature difference per kelvin of scaled flux.
    pub const fn set_display_layer(&mut self, resistance: U16F16) {
        self.bodies.resistances.display_layer = resistance;
    }

    /// Assumes this finger from now on.
    pub fn choose_finger(&mut self, finger: AssumedFinger) {
        self.finger = finger;
        self.restore_assumed_finger();
        self.choose_contact_law(&ChosenContactLaw::NOMINAL);
        self.bodies.are_half_spaces = self.is_half_space && finger == AssumedFinger::Thesis;
    }

    /// Discards what was learnt of the finger that touches. A contact law that was set stays.
    pub const fn restore_assumed_finger(&mut self) {
        self.bodies.finger = *self.finger.body();
        self.bodies.resistances.skin_factor = OwnResistances::NONE.skin_factor;
    }

    /// Takes this for the contact law of the finger from now on; what was learnt of its resistance was learnt by another one.
    pub const fn choose_contact_law(&mut self, law: &ChosenContactLaw) {
        self.contact_law = law.sent;
        self.bodies.resistances.law = law.own;
        self.bodies.resistances.skin_factor = OwnResistances::NONE.skin_factor;
    }

    /// Gives the assumed finger what was learnt of the one that touches: its tissue, the relative change of the flux that the air
    /// took from it, and the factor on its contact resistance.
    pub fn learn_finger(&mut self, tissue: &Body, air_flux_deviation: I4F28, skin_factor: I4F28) {
        let air = u64::from(self.finger.body().air.to_bits());
        let factor = air_flux_deviation.saturating_add(I4F28::ONE).max(I4F28::ZERO);
        let air = (air * u64::from(factor.to_bits().unsigned_abs())) >> I4F28::FRAC_NBITS;
        // Each by itself, so that the tissue is copied once.
        self.bodies.finger.tissue = *tissue;
        self.bodies.finger.air = Fraction::from_bits(air.min(u32::MAX.into()) as u32);
        self.bodies.resistances.skin_factor = skin_factor;
    }

    /// The finger that is assumed for the one that touches.
    pub const fn assumed_finger(&self) -> AssumedFinger {
        self.finger
    }

    /// The assumed finger and the object.
    pub const fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// Input of the reference generator, which computes set-point and target in the states preset and contact: contact
    /// constants, bodies, object temperature and contact model. `None` before a material is chosen.
    pub fn presented_object_if_chosen(&self) -> Option<PresentedObject<'_>> {
        Some(PresentedObject {
            pair: &self.material.as_ref()?.pair,
            bodies: self.bodies(),
            object: self.temperature,
            mode: self.mode,
        })
    }
}

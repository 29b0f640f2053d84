//! Thermal state of the skin: the thesis's half-space, or the tissue of another finger.

use contact_model::fixed_point::{
    Body, BodyState, Celsius, FingerBody, HalfSpace, saturating_product,
};

/// Assumed finger and presented object, where they are not both half-spaces. The thesis's equations then do not hold, and
/// finger and object are each followed by relaxations of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bodies<'a> {
    /// The assumed finger.
    pub finger: &'a FingerBody,
    /// The presented object.
    pub object: &'a Body,
}

/// Thermal state of a finger's skin. Its output is the cooling of the skin's surface since before the contact, K: positive
/// where the skin is colder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkinState {
    /// The thesis's finger and an object that are both half-spaces: one state stands for both.
    HalfSpace(HalfSpace),
    /// The tissue of an assumed finger.
    Body(BodyState),
}

impl Default for SkinState {
    fn default() -> Self {
        Self::HalfSpace(HalfSpace::default())
    }
}

impl SkinState {
    /// Uniform skin of the kind that these bodies need, unless it is of that kind. The history of the contact is lost when
    /// the kind changes: the skin then counts as recovered.
    #[inline]
    pub fn make_fit(&mut self, bodies: Option<Bodies<'_>>) {
        match (&*self, bodies) {
            (Self::HalfSpace(_), None) | (Self::Body(_), Some(_)) => {}
            (Self::Body(state), None) => {
                *self = Self::HalfSpace(HalfSpace::uniform_in_step_with(state));
            }
            (Self::HalfSpace(state), Some(_)) => *self = Self::Body(state.uniform_body()),
        }
    }

    /// The same state with updates of its slow relaxations at other ticks, for the simulated skin beside the real one.
    #[must_use]
    pub fn staggered(&self, bodies: Option<Bodies<'_>>) -> Self {
        match (self, bodies) {
            (Self::HalfSpace(state), _) => Self::HalfSpace(state.staggered()),
            (Self::Body(state), Some(bodies)) => {
                Self::Body(state.staggered(&bodies.finger.tissue.relaxations()))
            }
            (Self::Body(state), None) => Self::Body(*state),
        }
    }

    /// Cooling of the skin's surface at the end of the coming tick, K, if no heat flows in it.
    #[must_use]
    pub const fn free_response(&self) -> Celsius {
        match self {
            Self::HalfSpace(state) => state.free_response(),
            Self::Body(state) => state.free_response(),
        }
    }
}

/// Scaled flux by which the heat that a skin loses differs from that before contact: `into_object` in contact, `None`
/// without. `skin_above_room` is the temperature difference before contact, K, which drove the heat into the film of air
/// that the contact takes away; without contact the film cools a warm skin, and warms a cold one less.
#[must_use]
pub fn flux_beyond_air(
    finger: &FingerBody,
    into_object: Option<Celsius>,
    cooling: Celsius,
    skin_above_room: Celsius,
) -> Celsius {
    match into_object {
        Some(flux) => flux.saturating_sub(saturating_product(skin_above_room, finger.air)),
        None => saturating_product(cooling.saturating_neg(), finger.air),
    }
}

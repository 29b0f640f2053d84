//! Thermal state of the skin: the thesis's half-space, or the tissue of another finger.

use contact_model::fixed_point::{BodyState, Celsius, FingerBody, HalfSpace, ScaledBody, product};

/// Assumed finger and presented object, where they are not both half-spaces. The thesis's equations then do not hold, and
/// finger and object are each followed by relaxations of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bodies<'a> {
    /// The assumed finger.
    pub finger: &'a FingerBody,
    /// The presented object.
    pub object: ScaledBody<'a>,
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
    /// Advances the skin by one tick, in contact with the scaled flux `into_object`, or without contact for `None`.
    /// `skin_above_room` is the temperature difference before contact, K.
    #[inline]
    pub fn step(
        &mut self,
        into_object: Option<Celsius>,
        bodies: Option<Bodies<'_>>,
        skin_above_room: Celsius,
    ) {
        match (&mut *self, bodies) {
            (Self::HalfSpace(state), None) => state.step(into_object.unwrap_or(Celsius::ZERO)),
            _ => self.step_body(into_object, bodies, skin_above_room),
        }
    }

    /// As [`Self::step`], for a skin that is no half-space or was none in the tick before. A skin of another kind starts
    /// uniform: the history of the contact is lost, as if the skin had recovered.
    #[inline(never)]
    fn step_body(
        &mut self,
        into_object: Option<Celsius>,
        bodies: Option<Bodies<'_>>,
        skin_above_room: Celsius,
    ) {
        match (&*self, bodies) {
            (Self::Body(state), None) => {
                *self = Self::HalfSpace(HalfSpace::uniform_in_step_with(state));
            }
            (Self::HalfSpace(state), Some(_)) => *self = Self::Body(state.uniform_body()),
            _ => {}
        }
        match (self, bodies) {
            (Self::Body(state), Some(Bodies { finger, .. })) => {
                let flux =
                    flux_beyond_air(finger, into_object, state.free_response(), skin_above_room);
                state.step(flux, &finger.tissue.relaxations());
            }
            (Self::HalfSpace(state), _) => state.step(into_object.unwrap_or(Celsius::ZERO)),
            (Self::Body(_), None) => {}
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
        Some(flux) => flux.saturating_sub(product(skin_above_room, finger.air)),
        None => product(cooling.saturating_neg(), finger.air),
    }
}

//! Thermal state of the skin: the thesis's half-space, or the tissue of another finger.

use contact_model::fixed_point::{
    Body, Celsius, ContactConductance, FingerBody, HalfSpace, OwnResistances, ScaledBody,
    TissueState, TissueStateFactors, product,
};
use fixed::types::U16F16;

use super::PreContactTemperatures;

/// Assumed finger and presented object. Where they are not both half-spaces, the thesis's equations do not hold, and
/// finger and object are each followed by relaxations of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bodies {
    /// The assumed finger.
    pub finger: FingerBody,
    /// The presented object.
    pub object: ScaledBody,
    /// In which resistances the finger's contacts differ; not used while both are half-spaces.
    pub resistances: OwnResistances,
    /// Whether both are half-spaces.
    pub are_half_spaces: bool,
}

impl Bodies {
    /// The thesis's finger, and an object of the same effusivity.
    pub const HALF_SPACES: Self = Self {
        finger: FingerBody::THESIS,
        object: ScaledBody::half_space(U16F16::ONE),
        resistances: OwnResistances::NONE,
        are_half_spaces: true,
    };
}

/// Thermal state of a finger's skin. Its output is the cooling of the skin's surface since before the contact, K: positive
/// where the skin is colder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkinState {
    /// The thesis's finger and an object that are both half-spaces: one state stands for both.
    HalfSpace(HalfSpace),
    /// The tissue of an assumed finger.
    Body(TissueState),
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
        bodies: &Bodies,
        skin_above_room: Celsius,
    ) {
        if !bodies.are_half_spaces {
            self.step_tissue(into_object, &bodies.finger, skin_above_room);
        } else if let Some(state) = self.half_space() {
            state.step(into_object.unwrap_or(Celsius::ZERO));
        }
    }

    /// Advances the skin by one tick in contact with a display whose surface has the temperature `surface`, °C, by the
    /// conductance `display`, or without contact for `None`. Returns the scaled flux into the display, K, 0 without
    /// contact.
    #[inline(always)]
    pub fn step_on_display(
        &mut self,
        display: Option<&ContactConductance>,
        bodies: &Bodies,
        before: &PreContactTemperatures,
        surface: Celsius,
    ) -> Celsius {
        let skin_above_room = before.skin.saturating_sub(before.room);
        let scaled_flux = display.map(|conductance| {
            let above_display = before.skin.saturating_sub(surface);
            conductance.scaled_flux_by(above_display.saturating_sub(self.free_response()))
        });
        self.step(scaled_flux, bodies, skin_above_room);
        scaled_flux.unwrap_or(Celsius::ZERO)
    }

    /// [`Self::step`] of a finger that is no half-space, apart from the code of the thesis's.
    #[inline(never)]
    fn step_tissue(
        &mut self,
        into_object: Option<Celsius>,
        finger: &FingerBody,
        skin_above_room: Celsius,
    ) {
        if let Some(state) = self.tissue() {
            let flux = flux_beyond_air(finger, into_object, state.free_response(), skin_above_room);
            state.step(flux, &finger.tissue.relaxations());
        }
    }

    /// The state as that of a half-space. A skin that was another kind in the tick before starts uniform: the history of
    /// the contact is lost, as if the skin had recovered. Never `None`.
    #[inline(always)]
    pub fn half_space(&mut self) -> Option<&mut HalfSpace> {
        if let Self::Body(_) = self {
            self.change_kind();
        }
        match self {
            Self::HalfSpace(state) => Some(state),
            Self::Body(_) => None,
        }
    }

    /// The state as that of an assumed finger's tissue, as [`Self::half_space`].
    #[inline(always)]
    pub fn tissue(&mut self) -> Option<&mut TissueState> {
        if let Self::HalfSpace(_) = self {
            self.change_kind();
        }
        match self {
            Self::HalfSpace(_) => None,
            Self::Body(state) => Some(state),
        }
    }

    /// Makes a tissue uniform, because its relaxations are those of another one from now on. A half-space stays.
    pub fn forget_tissue_history(&mut self) {
        if let Self::Body(state) = self {
            *state = TissueState::uniform_in_step_with(state);
        }
    }

    /// Makes the state of a tissue that which the same heat would have made in the tissue `to`. A half-space stays.
    pub fn change_tissue(&mut self, factors: &TissueStateFactors, to: &Body) {
        if let Self::Body(state) = self {
            state.rescale(factors, &to.relaxations());
        }
    }

    /// A uniform skin of the other kind, with the rhythm of this one's updates.
    #[cold]
    #[inline(never)]
    fn change_kind(&mut self) {
        *self = match self {
            Self::HalfSpace(state) => Self::Body(state.uniform_tissue()),
            Self::Body(state) => Self::HalfSpace(HalfSpace::uniform_in_step_with(state)),
        };
    }

    /// The same state with updates of its slow relaxations at other ticks, for the simulated skin beside the real one.
    pub fn staggered(&self, bodies: &Bodies) -> Self {
        match self {
            Self::HalfSpace(state) => Self::HalfSpace(state.staggered()),
            Self::Body(state) => Self::Body(state.staggered(&bodies.finger.tissue.relaxations())),
        }
    }

    /// Cooling of the skin's surface at the end of the coming tick, K, if no heat flows in it.
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

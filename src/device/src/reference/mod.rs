//! The reference of the control loop: the display temperature that makes the finger feel the object.
//!
//! Before contact the display waits at its preset, Eq. 6-12 at `t = 0`, from the skin's and the object's temperatures. From
//! landing on it follows Eq. 6-12, and returns to the preset when the finger lifts. In the semi-infinite mode (chapter 4 of
//! the thesis) it stays at the interface temperature of Eq. 3-1.

mod equivalent_forces;
mod skin_on_object;

use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, ChordInterpolation, ContactPair, Force};

use crate::estimate::{FingerContact, FingerEstimator, ForceChange, PreContact};
use crate::safety::Setpoint;
use equivalent_forces::equivalent_forces;
use skin_on_object::{PairFactors, SkinOnObject};

/// Largest error of the interpolated set-point against Eq. 6-12 at the force for which the contact resistance was computed,
/// K. Noise of the force adds to it, 0.5 mK in all.
pub const TOLERANCE: Celsius = Celsius::lit("0.0004");
/// A display that is farther than this from its preset at landing was late.
const LATE: Celsius = Celsius::lit("0.1");
/// Part of the difference between skin and preset, as a power of two, by which a display waits below its preset.
const LEAD_SHIFT: u32 = 7;

/// Which model gives the set-point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Eq. 6-12, with contact resistance: the set-point changes during contact.
    #[default]
    ContactResistance,
    /// Eq. 3-1, perfect contact: the set-point is constant.
    SemiInfinite,
}

/// The object that is presented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene<'a> {
    /// The object's material under a finger, beside the display.
    pub pair: &'a ContactPair,
    /// Temperature of the object before contact; `None` takes that of the room.
    pub object: Option<Celsius>,
    /// Model that gives the set-point.
    pub mode: Mode,
}

/// Where the display should be in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Set-point that is reported, and that the proportional-integral laws control to.
    pub setpoint: Setpoint,
    /// The set-point had to be limited to the safe range.
    pub limited: bool,
    /// Set-point plus what brings the skin back to where the object would have it; the model law controls to it.
    pub target: Setpoint,
}

impl Reference {
    /// Limits both temperatures to the safe range.
    #[must_use]
    pub fn new(setpoint: Celsius, target: Celsius) -> Self {
        let (setpoint, limited) = Setpoint::saturating_celsius(setpoint);
        let (target, _) = Setpoint::saturating_celsius(target);
        Self {
            setpoint,
            limited,
            target,
        }
    }

    /// A set-point without a correction of the skin.
    #[must_use]
    pub fn at(setpoint: Celsius) -> Self {
        Self::new(setpoint, setpoint)
    }
}

/// A contact with the presented object.
#[derive(Clone, Debug, PartialEq, Eq)]
struct ObjectContact {
    /// Ticks since the contact with the object began.
    elapsed: u64,
    /// Forces for which Eq. 6-12 need not be evaluated again.
    equivalent_forces: RangeInclusive<Force>,
    /// Eq. 6-12 in closed form, while that holds.
    interpolation: Option<ChordInterpolation>,
    /// The interpolation must be rebuilt for the present force. The conductances that it needs are computed one tick
    /// earlier, so that no tick pays for both.
    rebuild: bool,
    /// The conductances for the rebuild have been computed in an earlier tick.
    prepared: bool,
}

impl ObjectContact {
    /// A contact begins. A finger that rests on the display when the object appears touches the object from now on.
    fn begin(finger: &FingerContact) -> Self {
        let has_just_landed = finger.change() == ForceChange::New;
        Self {
            elapsed: if has_just_landed { finger.elapsed() } else { 0 },
            equivalent_forces: Force::ZERO..=Force::ZERO,
            interpolation: None,
            rebuild: false,
            prepared: false,
        }
    }

    /// Decides whether the interpolation must be rebuilt, and takes the finger's mean force into use one tick before.
    fn schedule(
        &mut self,
        finger: &mut FingerContact,
        pair: &ContactPair,
        closed_form: bool,
        follow_skin: bool,
    ) {
        let is_new = finger.change() == ForceChange::New;
        let force = finger.force();
        let is_equivalent =
            !force.is_more_accurate() || self.equivalent_forces.contains(&force.mean());
        if !closed_form || (is_new && follow_skin) {
            self.interpolation = None;
        }
        let was_scheduled = self.rebuild && closed_form && !is_new;
        self.rebuild = closed_form
            && (finger.change() != ForceChange::Noise
                || !is_equivalent
                || was_scheduled
                || self.interpolation.is_none());
        self.prepared = was_scheduled && finger.contact_in_use().is_some();
        if self.rebuild && !self.prepared {
            finger.use_mean_force(pair);
        }
    }

    /// The set-point by the interpolation of Eq. 6-12, which is rebuilt if that is due; `None` without one.
    fn interpolate(
        &mut self,
        finger: &FingerContact,
        (skin, object): (Celsius, Celsius),
        follow_skin: bool,
        evaluations: &mut u32,
    ) -> Option<Celsius> {
        match finger.contact_in_use() {
            // While the skin is followed, conductances and interpolation are not computed in the same tick.
            Some(contact) if self.rebuild && (self.prepared || !follow_skin) => {
                let (interpolation, count) =
                    ChordInterpolation::new(contact, skin, object, self.elapsed, TOLERANCE);
                *evaluations = evaluations.wrapping_add(count);
                self.equivalent_forces =
                    equivalent_forces(finger.force().in_use(), interpolation.transient_amplitude());
                self.rebuild = false;
                Some(self.interpolation.insert(interpolation).setpoint())
            }
            _ => {
                let interpolation = self.interpolation.as_mut()?;
                let setpoint = interpolation.advance();
                let count = interpolation.has_just_evaluated().into();
                *evaluations = evaluations.wrapping_add(count);
                Some(setpoint)
            }
        }
    }
}

/// Generates the reference while an object is presented.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReferenceGenerator {
    skin_on_object: SkinOnObject,
    /// Of the object that was presented last.
    factors: PairFactors,
    contact: Option<ObjectContact>,
    evaluations: u32,
}

/// How far below its preset a display waits for a finger.
///
/// In the first 10 ms of contact the finger brings heat that the bridge needs 50 ms to remove; removing half of it in advance
/// halves the trace on the skin. That heat is proportional to the flux for every material, and so to the difference between
/// skin and display.
fn lead(skin: Celsius, preset: Celsius) -> Celsius {
    skin.saturating_sub(preset) >> LEAD_SHIFT
}

impl ReferenceGenerator {
    /// Forgets the contact, because the finger was not observed.
    pub fn invalidate(&mut self) {
        *self = Self {
            evaluations: self.evaluations,
            ..Self::default()
        };
    }

    /// Evaluations of `erfcx` since reset.
    #[must_use]
    pub const fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// Lets the next tick begin a new contact, because another object is presented.
    pub fn restart_contact(&mut self, finger: &mut FingerEstimator) {
        self.contact = None;
        self.skin_on_object.restart(finger.skin_on_display());
        finger.forget_conductances();
    }

    /// The reference of this tick; `None` until the finger was observed. `surface` is that of the display.
    ///
    /// `follow_skin`: the skin is followed as it is on the display, and the target corrects it. Otherwise the closed form
    /// of Eq. 6-12 holds, as if every contact were the first and its force had always been the present one.
    pub fn update(
        &mut self,
        scene: &Scene<'_>,
        finger: &mut FingerEstimator,
        surface: Celsius,
        follow_skin: bool,
    ) -> Option<Reference> {
        let PreContact { skin, room } = finger.before_contact()?;
        let object = scene.object.unwrap_or(room);
        if scene.mode == Mode::SemiInfinite {
            self.contact = None;
            return Some(Reference::at(
                scene.pair.interface_temperature(skin, object),
            ));
        }
        let skin_above_object = skin.saturating_sub(object);
        if !self.factors.belong_to(scene.pair) {
            self.factors = PairFactors::new(scene.pair);
        }
        let factors = &self.factors;
        let (contact, skin_on_display) = finger.contact_and_skin();
        let Some(finger) = contact else {
            self.contact = None;
            self.skin_on_object.step(None, factors, skin_above_object);
            if !follow_skin {
                return Some(Reference::at(scene.pair.preset(skin, object)));
            }
            let setpoint = self.skin_on_object.setpoint(
                factors,
                skin,
                skin_above_object,
                Some(skin_on_display),
            );
            return Some(Reference::new(
                setpoint,
                setpoint.saturating_sub(lead(skin, setpoint)),
            ));
        };
        let contact = match &mut self.contact {
            Some(contact) => {
                contact.elapsed += 1;
                contact
            }
            none => {
                let preset = scene.pair.preset(skin, object);
                if is_late(surface, preset, lead(skin, preset)) {
                    finger.note_late_display();
                }
                none.insert(ObjectContact::begin(finger))
            }
        };
        let conductance = finger.conductances().map(|both| &both.object);
        (self.skin_on_object).step(conductance, factors, skin_above_object);
        let closed_form = finger.is_constant() || !follow_skin;
        contact.schedule(finger, scene.pair, closed_form, follow_skin);
        let interpolated =
            contact.interpolate(finger, (skin, object), follow_skin, &mut self.evaluations);
        let setpoint = interpolated.unwrap_or_else(|| {
            (self.skin_on_object).setpoint(factors, skin, skin_above_object, None)
        });
        let correction = match finger.conductances() {
            Some(both) if follow_skin => {
                (self.skin_on_object).correction(skin_on_display, &both.display)
            }
            _ => Celsius::ZERO,
        };
        let target = setpoint.saturating_add(correction);
        // A skin that is followed tick by tick has its correction in the reported set-point, too.
        let setpoint = if closed_form { setpoint } else { target };
        Some(Reference::new(setpoint, target))
    }
}

/// Whether a display is not where it should be at landing: half way between its preset and where it waits for the finger.
fn is_late(surface: Celsius, preset: Celsius, lead: Celsius) -> bool {
    let half_lead = lead >> 1u32;
    let error = surface.saturating_sub(preset).saturating_add(half_lead);
    error.abs() > LATE.saturating_add(half_lead.abs())
}

#[cfg(test)]
mod tests;

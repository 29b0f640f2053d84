//! The reference of the control loop: the display temperature that makes the finger feel the object.
//!
//! Before contact the display waits at its preset, Eq. 6-12 at `t = 0`, from the skin's and the object's temperatures. From
//! landing on it follows Eq. 6-12, and returns to the preset when the finger lifts. In the semi-infinite mode (chapter 4 of
//! the thesis) it stays at the interface temperature of Eq. 3-1.

mod equivalent_forces;
mod skin_on_object;

use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, ChordInterpolation, ContactPair, Force};

use crate::estimate::{FingerContact, FingerEstimator, ForceChange, PreContactTemperatures};
use crate::safety::Setpoint;
use equivalent_forces::equivalent_forces;
use skin_on_object::{PairFactors, SkinOnObject};

/// Largest error, K, of the interpolated set-point against Eq. 6-12 at the force for which the contact resistance was
/// computed. Noise of the force adds up to 0.1 mK to it, 0.5 mK in all.
pub const INTERPOLATION_TOLERANCE: Celsius = Celsius::lit("0.0004");
/// Error of the display's surface at landing, K, beyond the range from its preset to where it waits below the preset,
/// from which the closed form of Eq. 6-12 is not used for the contact.
const LATE_DISPLAY_ERROR: Celsius = Celsius::lit("0.1");
/// A display waits below its preset by 1/128 (this power of two) of the difference between skin and preset temperature.
const WAITING_LEAD_SHIFT: u32 = 7;

/// Which contact model of the thesis gives the set-point; chosen by the host's command `mode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Eq. 6-12, with contact resistance between skin and object: the set-point changes during contact.
    #[default]
    ContactResistance,
    /// Eq. 3-1, perfect contact of two half-spaces: the set-point is their constant interface temperature, before and
    /// during contact.
    SemiInfinite,
}

/// The object that the host has chosen to present, with the model of the contact: all that the reference generator
/// needs beside finger and display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene<'a> {
    /// Thermal properties of skin, presented material and display surface, from which contact conductances and
    /// set-points follow.
    pub pair: &'a ContactPair,
    /// Temperature of the object before contact, °C; `None` stands for that of the room.
    pub object: Option<Celsius>,
    /// Contact model of the set-point: with contact resistance (Eq. 6-12) or perfect contact (Eq. 3-1). Independent of the
    /// control law.
    pub mode: Mode,
}

/// The temperatures to which the control loop brings the display in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Set-point in °C that is reported to the host and checked by the fault detectors, and to which the laws `pi` and
    /// `pi-10hz` control.
    pub setpoint: Setpoint,
    /// Whether the wanted set-point was outside the safe range and had to be limited to it; reported to the host.
    pub limited: bool,
    /// Temperature in °C to which the law `model` controls: the set-point, plus what brings a skin that is too warm or
    /// too cold back to where the object would have it; while no finger touches, less the lead below the preset.
    pub target: Setpoint,
}

impl Reference {
    /// A reference from a set-point and a target, °C, each limited to the safe range of 15 to 42 °C.
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

    /// A reference whose target is the set-point itself, °C, limited to the safe range: for a display that presents no
    /// object, and for the semi-infinite model.
    #[must_use]
    pub fn at(setpoint: Celsius) -> Self {
        Self::new(setpoint, setpoint)
    }
}

/// The contact of a finger with the presented object: its time, and the interpolation of its set-points. It begins at
/// landing, or when an object is first presented, or another one, under a finger.
#[derive(Clone, Debug, PartialEq, Eq)]
struct ObjectContact {
    /// Ticks of 1 ms since the contact with the object began.
    elapsed: u64,
    /// Forces, N, for which the interpolation holds within 0.1 mK, so that Eq. 6-12 need not be evaluated again.
    equivalent_forces: RangeInclusive<Force>,
    /// Interpolation of Eq. 6-12 in closed form. `None` before the first one, while the closed form does not describe
    /// the contact, and with the law `model` after a new force until the next one is computed.
    interpolation: Option<ChordInterpolation>,
    /// Whether the interpolation must be computed again for the present mean force. The conductances that it needs are
    /// computed one tick earlier, so that no tick pays for both.
    rebuild: bool,
    /// Whether the conductances for the new interpolation have been computed in an earlier tick.
    prepared: bool,
}

impl ObjectContact {
    /// A contact with the object, in its first tick. If the finger has just landed, the time counts from its landing;
    /// if it rested on the display already when the object appeared, the time counts from now.
    fn begin_contact(finger: &FingerContact) -> Self {
        let has_just_landed = finger.force_change() == ForceChange::New;
        Self {
            elapsed: if has_just_landed {
                finger.ticks_since_landing()
            } else {
                0
            },
            equivalent_forces: Force::ZERO..=Force::ZERO,
            interpolation: None,
            rebuild: false,
            prepared: false,
        }
    }

    /// Decides whether the interpolation must be computed again: without one, after a new or drifting force, or when
    /// the mean force has left the equivalent forces. Then makes the mean force the one for set-points, in the tick
    /// before. `closed_form`: the closed form of Eq. 6-12 describes the contact. `follow_skin`: as in
    /// [`ReferenceGenerator::next_reference`].
    fn schedule_rebuild(
        &mut self,
        finger: &mut FingerContact,
        pair: &ContactPair,
        closed_form: bool,
        follow_skin: bool,
    ) {
        let is_new = finger.force_change() == ForceChange::New;
        let force = finger.force_mean();
        let is_equivalent =
            !force.has_doubled_ticks() || self.equivalent_forces.contains(&force.mean());
        if !closed_form || (is_new && follow_skin) {
            self.interpolation = None;
        }
        let was_scheduled = self.rebuild && closed_form && !is_new;
        self.rebuild = closed_form
            && (finger.force_change() != ForceChange::Noise
                || !is_equivalent
                || was_scheduled
                || self.interpolation.is_none());
        self.prepared = was_scheduled && finger.contact_at_force_in_use().is_some();
        if self.rebuild && !self.prepared {
            finger.use_mean_force(pair);
        }
    }

    /// The set-point, °C, of this tick by the interpolation of Eq. 6-12 between skin and object temperature, after
    /// computing the interpolation again if that is due. Adds the evaluations of `erfcx` to `evaluations`. `None`
    /// without an interpolation.
    fn interpolated_setpoint(
        &mut self,
        finger: &FingerContact,
        (skin, object): (Celsius, Celsius),
        follow_skin: bool,
        evaluations: &mut u32,
    ) -> Option<Celsius> {
        match finger.contact_at_force_in_use() {
            // While the skin is followed, conductances and interpolation are not computed in the same tick.
            Some(contact) if self.rebuild && (self.prepared || !follow_skin) => {
                let (interpolation, count) = ChordInterpolation::new(
                    contact,
                    skin,
                    object,
                    self.elapsed,
                    INTERPOLATION_TOLERANCE,
                );
                *evaluations = evaluations.wrapping_add(count);
                self.equivalent_forces = equivalent_forces(
                    finger.force_mean().mean_in_use(),
                    interpolation.transient_amplitude(),
                );
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

/// Generates the reference of each tick while an object is presented: the display temperature by which the finger feels
/// the object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReferenceGenerator {
    /// Simulated cooling of the skin as it would be on the presented object.
    skin_on_object: SkinOnObject,
    /// Factors of Eq. 6-12 for the object that was presented last.
    factors: PairFactors,
    /// The present contact with the object; `None` while no finger touches, and in the semi-infinite model.
    contact: Option<ObjectContact>,
    /// Evaluations of `erfcx`, the costly function in Eq. 6-12, since reset; wraps.
    evaluations: u32,
}

/// How far below its preset a display waits for a finger, K; negative, so above it, for a skin that is colder than the
/// preset.
///
/// In the first 10 ms of contact the finger brings heat that the bridge needs 50 ms to remove; removing half of it in
/// advance halves the trace on the skin. That heat is proportional to the flux for every material, and so to the
/// difference between skin and display.
fn waiting_lead(skin: Celsius, preset: Celsius) -> Celsius {
    skin.saturating_sub(preset) >> WAITING_LEAD_SHIFT
}

impl ReferenceGenerator {
    /// Forgets the contact and the skin on the object, but not the number of evaluations. Called in a tick whose
    /// readings are invalid, because then the finger may have landed or lifted unseen.
    pub fn invalidate(&mut self) {
        *self = Self {
            evaluations: self.evaluations,
            ..Self::default()
        };
    }

    /// Number of evaluations of `erfcx` since reset, for the telemetry: the costly part of the set-point's computation.
    /// Wraps.
    #[must_use]
    pub const fn erfcx_evaluations(&self) -> u32 {
        self.evaluations
    }

    /// Lets the next tick begin a new contact by a finger that rests on the display, with the skin as the display has
    /// left it. Called when the host changes material, temperature or model of the object, and at `start`.
    pub fn restart_contact(&mut self, finger: &mut FingerEstimator) {
        self.contact = None;
        self.skin_on_object
            .restart_contact(finger.skin_on_display());
        finger.forget_conductances();
    }

    /// Set-point and target of this tick; `None` before skin and room have been read.
    ///
    /// In the semi-infinite mode both are the constant temperature of Eq. 3-1. Otherwise they follow Eq. 6-12: without
    /// `follow_skin` in closed form, as for a first contact under a constant force; with it (law `model`) in closed form
    /// only while that describes the contact, else from the simulated skin on the object, and the target also corrects the
    /// difference between the skin on the display and that on the object. `surface`, °C, is the display's surface
    /// temperature; it only decides at landing whether the display was late, which excludes the closed form.
    pub fn next_reference(
        &mut self,
        scene: &Scene<'_>,
        finger: &mut FingerEstimator,
        surface: Celsius,
        follow_skin: bool,
    ) -> Option<Reference> {
        let PreContactTemperatures { skin, room } = finger.temperatures_before_contact()?;
        let object = scene.object.unwrap_or(room);
        if scene.mode == Mode::SemiInfinite {
            self.contact = None;
            return Some(Reference::at(
                scene.pair.interface_temperature(skin, object),
            ));
        }
        let skin_above_object = skin.saturating_sub(object);
        if !self.factors.are_those_of(scene.pair) {
            self.factors = PairFactors::new(scene.pair);
        }
        let factors = &self.factors;
        let (contact, skin_on_display) = finger.contact_and_skin_on_display();
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
                setpoint.saturating_sub(waiting_lead(skin, setpoint)),
            ));
        };
        let contact = match &mut self.contact {
            Some(contact) => {
                contact.elapsed += 1;
                contact
            }
            none => {
                let preset = scene.pair.preset(skin, object);
                if is_display_late(surface, preset, waiting_lead(skin, preset)) {
                    finger.note_late_display();
                }
                none.insert(ObjectContact::begin_contact(finger))
            }
        };
        let conductance = finger.conductances().map(|both| &both.object);
        (self.skin_on_object).step(conductance, factors, skin_above_object);
        let closed_form = finger.has_closed_form() || !follow_skin;
        contact.schedule_rebuild(finger, scene.pair, closed_form, follow_skin);
        let interpolated = contact.interpolated_setpoint(
            finger,
            (skin, object),
            follow_skin,
            &mut self.evaluations,
        );
        let setpoint = interpolated.unwrap_or_else(|| {
            (self.skin_on_object).setpoint(factors, skin, skin_above_object, None)
        });
        let correction = match finger.conductances() {
            Some(both) if follow_skin => {
                (self.skin_on_object).setpoint_correction(skin_on_display, &both.display)
            }
            _ => Celsius::ZERO,
        };
        let target = setpoint.saturating_add(correction);
        // A skin that is followed tick by tick has its correction in the reported set-point, too.
        let setpoint = if closed_form { setpoint } else { target };
        Some(Reference::new(setpoint, target))
    }
}

/// Whether the display's surface at landing is more than 0.1 K outside the range between the preset and the preset less
/// `lead`, K. A contact that begins so does not follow the closed form of Eq. 6-12.
fn is_display_late(surface: Celsius, preset: Celsius, lead: Celsius) -> bool {
    let half_lead = lead >> 1u32;
    let error = surface.saturating_sub(preset).saturating_add(half_lead);
    error.abs() > LATE_DISPLAY_ERROR.saturating_add(half_lead.abs())
}

#[cfg(test)]
mod tests;

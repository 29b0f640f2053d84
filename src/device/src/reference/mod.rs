//! The reference of the control loop: the display temperature that makes the finger feel the object.
//!
//! Before contact the display waits at its preset, which is Eq. 6-12 at `t = 0` for the temperatures of skin and
//! object. From landing on, the reference follows Eq. 6-12; when the finger lifts, it becomes the preset again. In the
//! semi-infinite mode (chapter 4 of the thesis) the reference is always the interface temperature of Eq. 3-1.

mod equivalent_forces;
mod limiter;
mod setpoint_lead;
mod skin_on_object;

use core::ops::RangeInclusive;
use thermal_settings::vocabulary;

use contact_model::fixed_point::{
    Body, Celsius, ChordInterpolation, ContactPair, Force, Fraction, TissueStateFactors, preset,
    saturating_product,
};

use fixed::types::U16F16;

use crate::estimate::{
    Bodies, FingerContact, FingerEstimator, ForceChange, PreContactTemperatures,
};
use crate::safety::Setpoint;
use equivalent_forces::equivalent_forces;
pub use limiter::ReferenceLimits;
use setpoint_lead::SetpointLead;
use skin_on_object::{BodiesBeforeContact, ContactPairFactors, SkinOnObject};

/// Largest error, K, of the set-point by interpolation in time, compared with Eq. 6-12 for the same force: 0.4 mK. The
/// smaller it is, the more often Eq. 6-12 must be evaluated. Noise of the force may add up to 0.1 mK before the
/// interpolation is computed again, which gives 0.5 mK in all.
pub const SETPOINT_INTERPOLATION_TOLERANCE: Celsius = Celsius::lit("0.0004");
/// Largest distance, K, of the display's surface temperature in the first tick of a contact from the range in which the
/// display should wait: from the preset (the set-point before contact) to the waiting temperature below it. After a
/// larger error the law `model` does not use the closed form of Eq. 6-12 for this contact, because the closed form
/// assumes a start at the preset.
const PRESET_TO_WAITING_RANGE_MARGIN: Celsius = Celsius::lit("0.1");
/// Divisor of the waiting offset as a power of two: 2^7 = 128. While a display waits for a finger, the law `model`
/// keeps it below its preset, the set-point before contact, by the difference of skin temperature and preset divided by
/// 128.
const WAITING_OFFSET_DIVISOR_LOG2: u32 = 7;

vocabulary! {
    /// Contact model that gives the set-point while an object is presented; chosen by the host's command `mode`. The
    /// equations are those of Ho's thesis (MIT 2006).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum ContactModel: "mode" {
        /// Command `mode contact`: Eq. 6-12, two semi-infinite bodies with a thermal contact resistance between skin and
        /// object. The set-point before contact, the preset, is Eq. 6-12 at `t = 0`; during contact the set-point changes
        /// with time and force.
        #[default]
        ContactResistance = "contact",
        /// Command `mode semi-infinite`: Eq. 3-1, two semi-infinite bodies in perfect contact. The set-point is their
        /// constant interface temperature, before and during contact.
        SemiInfinite = "semi-infinite",
    }
}

/// The object that the host has chosen to present, and the contact model. The reference generator computes the
/// set-point from a scene, the state of the finger, and the temperature of the display's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PresentedObject<'a> {
    /// Constants of the contact of a finger's skin with the presented material, and of its contact with the display's
    /// surface. Contact conductances and set-points are computed from them.
    pub pair: &'a ContactPair,
    /// Assumed finger and presented object. If they are not both half-spaces, Eq. 6-12 does not hold, and the set-point
    /// follows from the simulated skin on the object with every control law.
    pub bodies: &'a Bodies,
    /// Temperature of the object before contact, °C; `None` takes the temperature of the room.
    pub object: Option<Celsius>,
    /// Contact model that gives the set-point: with contact resistance (Eq. 6-12) or perfect contact (Eq. 3-1).
    pub mode: ContactModel,
}

/// Desired temperatures of the display in one tick: the set-point, to which the control laws `pi` and `pi-10hz`
/// control, and the target, to which the law `model` controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Set-point, 15 to 42 °C. The laws `pi` and `pi-10hz` control the display's reading to it, the fault detectors
    /// check the reading against it, and the host gets it in status and telemetry. With the law `model`, in a contact
    /// for which the closed form of Eq. 6-12 is not valid, it contains the correction of the target.
    pub setpoint: Setpoint,
    /// Whether the set-point had to be limited, because the computed one was outside the safe range of 15 to 42 °C or
    /// beyond what [`ReferenceLimits`] allow; reported to the host. A limited target does not count.
    pub limited: bool,
    /// Target, 15 to 42 °C, to which the law `model` controls. It differs from the set-point only with this law and the
    /// contact model with contact resistance. During contact it is the temperature by Eq. 6-12 plus a correction, which
    /// brings a skin that is too warm or too cold to the temperature that it would have on the object; where finger and
    /// object are followed as bodies, it is also ahead of a set-point that rises or falls. While the
    /// display waits for a finger, it is below the set-point by 1/128 of the difference from the set-point to the
    /// skin's temperature.
    pub target: Setpoint,
}

impl Reference {
    /// A reference from a set-point and a target, °C, each limited to the safe range of 15 to 42 °C. `limited` is set
    /// if the set-point was outside this range.
    pub fn limited_to_safe_range(setpoint: Celsius, target: Celsius) -> Self {
        let (setpoint, limited) = Setpoint::clamp_celsius_with_flag(setpoint);
        let (target, _) = Setpoint::clamp_celsius_with_flag(target);
        Self { setpoint, limited, target }
    }

    /// A reference whose set-point and target are the same temperature, °C, limited to 15 to 42 °C. Used while no
    /// object is presented, for the semi-infinite contact model, and, with the laws `pi` and `pi-10hz`, while no finger
    /// touches.
    pub fn at(setpoint: Celsius) -> Self {
        Self::limited_to_safe_range(setpoint, setpoint)
    }
}

/// One contact of a finger with the presented object: its time, and the interpolation of its set-points. It begins when
/// the finger lands. While a finger rests on the display, a new one begins at `start`, and when the host chooses a
/// material, object temperature or contact model.
#[derive(Clone, Debug, PartialEq, Eq)]
struct ContactSetpoints {
    /// Time `t` of Eq. 6-12, ticks of 1 ms since the finger landed. If the host has sent `start` or chosen another
    /// material, object temperature or contact model under a resting finger: ticks since then, because the transient of
    /// Eq. 6-12 begins anew with the new object.
    elapsed: u64,
    /// Forces, N, for which the set-point by Eq. 6-12 differs by at most 0.1 mK from that of the present interpolation.
    /// While the mean force stays in this range, noise of the force causes no new interpolation.
    equivalent_forces: RangeInclusive<Force>,
    /// Interpolation of the closed form of Eq. 6-12. `None` until the first one is computed. With the law `model` it is
    /// also `None` while the closed form is not valid for the contact, and from a jump of the force until the
    /// interpolation for the new force is computed. Without an interpolation the set-point follows from the simulated
    /// skin on the object.
    interpolation: Option<ChordInterpolation>,
    /// Whether the interpolation must be computed for the present mean force. With the law `model` the contact
    /// conductances are computed in one tick and the interpolation in the next, so that no tick takes the time of both;
    /// the other laws compute both in one tick.
    interpolation_due: bool,
    /// Whether an earlier tick has computed the contact conductances for the interpolation that is due. With the law
    /// `model` the interpolation is computed only in a tick in which this is true; the other laws do not use it.
    conductances_ready: bool,
}

impl ContactSetpoints {
    /// A contact with the object in its first tick. If the finger has just landed, so that its force is new in this
    /// tick, the contact's time is that since landing. Otherwise, as when the object is exchanged under a resting
    /// finger, the time is 0 in this tick.
    fn new_since_landing_or_now(finger: &FingerContact) -> Self {
        let has_just_landed = finger.force_change() == ForceChange::New;
        Self {
            elapsed: if has_just_landed { finger.ticks_since_landing() } else { 0 },
            equivalent_forces: Force::ZERO..=Force::ZERO,
            interpolation: None,
            interpolation_due: false,
            conductances_ready: false,
        }
    }

    /// Decides whether the interpolation of Eq. 6-12 must be computed: if there is none yet, after a jump or drift of
    /// the force, or if the mean force has left `equivalent_forces`, which is checked each time the number of averaged
    /// ticks has doubled. If so, the mean force becomes the one for set-points, and the contact conductances are
    /// computed for it. `closed_form` is whether the set-point is to be computed by the closed form of Eq. 6-12; if
    /// not, the interpolation is discarded. With `follow_skin` (law `model`) the interpolation itself is computed in
    /// the next tick.
    fn update_interpolation_due_and_conductances(
        &mut self,
        finger: &mut FingerContact,
        pair: &ContactPair,
        closed_form: bool,
        follow_skin: bool,
    ) {
        let is_new = finger.force_change() == ForceChange::New;
        let force = finger.force_means();
        let is_equivalent = !force.ticks_since_jump_are_power_of_two()
            || self.equivalent_forces.contains(&force.long_mean());
        if !closed_form || (is_new && follow_skin) {
            self.interpolation = None;
        }
        let was_scheduled = self.interpolation_due && closed_form && !is_new;
        self.interpolation_due = closed_form
            && (finger.force_change() != ForceChange::Noise
                || !is_equivalent
                || was_scheduled
                || self.interpolation.is_none());
        self.conductances_ready =
            was_scheduled && finger.contact_if_computed_for_setpoint_force().is_some();
        if self.interpolation_due && !self.conductances_ready {
            finger.adopt_setpoint_force_and_conductances(pair);
        }
    }

    /// The set-point of this tick, °C, by the interpolation of Eq. 6-12. Computes the interpolation first if it is due;
    /// with `follow_skin` (law `model`) only if an earlier tick has computed the conductances. `skin` and `object` are
    /// the temperatures before contact, °C. Adds the number of evaluations of `erfcx`, the costly function in Eq. 6-12,
    /// to `evaluations`. Returns `None` if there is no interpolation.
    fn interpolated_setpoint(
        &mut self,
        finger: &FingerContact,
        (skin, object): (Celsius, Celsius),
        follow_skin: bool,
        evaluations: &mut u32,
    ) -> Option<Celsius> {
        match finger.contact_if_computed_for_setpoint_force() {
            // While the skin is followed, conductances and interpolation are not computed in the same tick.
            Some(contact)
                if self.interpolation_due && (self.conductances_ready || !follow_skin) =>
            {
                let (interpolation, count) = ChordInterpolation::new(
                    contact,
                    skin,
                    object,
                    self.elapsed,
                    SETPOINT_INTERPOLATION_TOLERANCE,
                );
                *evaluations = evaluations.wrapping_add(count);
                self.equivalent_forces = equivalent_forces(
                    finger.force_means().mean_for_setpoints(),
                    interpolation.transient_amplitude(),
                );
                self.interpolation_due = false;
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

/// Generates the reference (set-point and target) of each tick while an object is presented: the display temperature at
/// which the finger's skin cools or warms as it would on the object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReferenceGenerator {
    skin_on_object: SkinOnObject,
    /// Constants of Eq. 6-12 for the object that was presented last; computed again when another one is presented.
    factors: ContactPairFactors,
    /// The present contact with the object. `None` while an object is presented and no finger touches, in the
    /// semi-infinite model, and from [`Self::restart_contact`] or [`Self::discard_contact_and_skin_simulation`] until the next reference is
    /// generated. Without an object it has no meaning.
    contact: Option<ContactSetpoints>,
    /// Lead of the target over the set-point in the present contact, where finger and object are followed as bodies.
    lead: SetpointLead,
    /// Number of evaluations of `erfcx`, the costly function in Eq. 6-12, since start-up; wraps at 2^32. For the
    /// telemetry.
    evaluations: u32,
}

/// How far below its preset (the set-point before contact) a display waits for a finger with the law `model`, K: the
/// skin's temperature minus the preset, divided by 128. Negative, so that the display waits above its preset, if the
/// skin is colder than the preset.
///
/// In the first 10 ms of a contact the finger brings heat that the bridge needs 50 ms to remove. The offset removes
/// half of this heat before the contact, which halves the error of the skin's temperature. For every material this heat
/// is proportional to the difference between skin and display.
fn waiting_offset_below_preset(skin: Celsius, preset: Celsius) -> Celsius {
    skin.saturating_sub(preset) >> WAITING_OFFSET_DIVISOR_LOG2
}

/// As [`waiting_offset_below_preset`], for a display with the layer of a heat-flux sensor on its face, and an object of this
/// weight: 3/64 of the difference times the weight.
///
/// The flux's drop across the layer is unknown before the first contact, because that of fingers differs by a factor of two,
/// and a display that must cool a strong flux's drop away is at the bridge's limit for 80 ms. To heat is quicker, because the module's
/// own heat helps. An object of a smaller weight draws less flux.
fn waiting_offset_below_layer(skin: Celsius, preset: Celsius, weight: Fraction) -> Celsius {
    let weighted: Celsius = saturating_product(skin.saturating_sub(preset), weight);
    (weighted >> 5u32).saturating_add(weighted >> 6u32)
}

impl ReferenceGenerator {
    /// Discards the contact with the object and the simulation of the skin; only the number of evaluations of `erfcx`
    /// is kept. Called in a tick with invalid readings or a detected fault, because the finger may have landed or
    /// lifted unnoticed in it.
    pub fn discard_contact_and_skin_simulation(&mut self) {
        *self = Self { evaluations: self.evaluations, ..Self::default() };
    }

    /// Number of evaluations since start-up of `erfcx`, the scaled complementary error function, which is the costly
    /// part of Eq. 6-12. For the telemetry; wraps at 2^32.
    pub const fn erfcx_evaluations(&self) -> u32 {
        self.evaluations
    }

    /// Lets a finger that touches the display begin a new contact with the object in the next tick. The simulated skin
    /// starts with the temperature that the real skin has on the display. Called when the host chooses another
    /// material, object temperature or contact model, and at `start`.
    pub fn restart_contact(&mut self, finger: &mut FingerEstimator, bodies: &Bodies) {
        self.contact = None;
        self.lead = SetpointLead::default();
        self.skin_on_object.start_from_skin_on_display(finger.skin_state_on_display(), bodies);
        finger.forget_conductances();
    }

    /// Goes on with the tissue `to`, and with the resistances of the finger that is presented next.
    pub fn change_finger(&mut self, factors: &TissueStateFactors, to: &Body) {
        self.skin_on_object.change_tissue(factors, to);
        self.forget_resistances();
    }

    /// Takes over the resistances of the finger that is presented next.
    pub fn forget_resistances(&mut self) {
        self.factors = ContactPairFactors::default();
    }

    /// Set-point and target of this tick. `None` if the finger's estimator has no temperatures of skin and room, that
    /// is before its first tick with valid readings and after [`FingerEstimator::invalidate`].
    ///
    /// In the semi-infinite mode both are the constant temperature of Eq. 3-1. In the mode with contact resistance both
    /// follow Eq. 6-12:
    ///
    /// - Without `follow_skin` (laws `pi` and `pi-10hz`) the target equals the set-point. While no finger touches, it
    ///   is the preset, Eq. 6-12 at landing. During contact it is computed by the closed form, as for a first contact
    ///   under a constant force.
    /// - With `follow_skin` (law `model`), while no finger touches, the set-point is the preset for the skin's present
    ///   temperature, which the last contact may still have changed, and the target lies below it by the waiting
    ///   offset. During contact the set-point is computed by the closed form while this is valid
    ///   ([`FingerContact::closed_form_is_valid`]) and its interpolation is computed, else from the simulated skin on
    ///   the object. The target adds a correction, by which the skin on the display follows the simulated skin; if the
    ///   closed form is not valid, the set-point contains this correction, too. With bodies the target is also ahead of
    ///   the set-point by `SetpointLead`.
    ///
    /// `surface` is the temperature of the display's surface, °C. It is used only in the first tick of a contact: if it
    /// is more than 0.1 K outside the range from the preset to the waiting temperature, the closed form is excluded for
    /// this contact with the law `model`.
    pub fn next_reference(
        &mut self,
        object_presented: &PresentedObject<'_>,
        finger: &mut FingerEstimator,
        surface: Celsius,
        follow_skin: bool,
    ) -> Option<Reference> {
        let PreContactTemperatures { skin, room } = finger.temperatures_before_contact()?;
        let object = object_presented.object.unwrap_or(room);
        if object_presented.mode == ContactModel::SemiInfinite {
            self.contact = None;
            return Some(Reference::at(object_presented.pair.interface_temperature(skin, object)));
        }
        if !self.factors.were_computed_for(object_presented.pair) {
            self.factors = ContactPairFactors::new(
                object_presented.pair,
                &object_presented.bodies.resistances,
            );
        }
        let skin_above_object = skin.saturating_sub(object);
        if !object_presented.bodies.are_half_spaces {
            let before = BodiesBeforeContact {
                bodies: object_presented.bodies,
                skin_above_object,
                skin_above_room: skin.saturating_sub(room),
            };
            return Some(self.next_reference_of_bodies(
                &before,
                (skin, object),
                finger,
                follow_skin,
            ));
        }
        let factors = &self.factors;
        let (contact, skin_state_on_display) = finger.contact_and_skin_state();
        let Some(finger) = contact else {
            self.contact = None;
            self.skin_on_object.step(None, factors, skin_above_object);
            if !follow_skin {
                return Some(Reference::at(object_presented.pair.preset(skin, object)));
            }
            let setpoint = self.skin_on_object.setpoint(
                factors,
                skin,
                skin_above_object,
                Some(skin_state_on_display),
            );
            return Some(Reference::limited_to_safe_range(
                setpoint,
                setpoint.saturating_sub(waiting_offset_below_preset(skin, setpoint)),
            ));
        };
        let contact = match &mut self.contact {
            Some(contact) => {
                contact.elapsed += 1;
                contact
            }
            none => {
                let preset = object_presented.pair.preset(skin, object);
                if is_display_outside_preset_to_waiting_range(
                    surface,
                    preset,
                    waiting_offset_below_preset(skin, preset),
                ) {
                    finger.exclude_closed_form();
                }
                none.insert(ContactSetpoints::new_since_landing_or_now(finger))
            }
        };
        let conductance = finger.stored_conductances().map(|both| &both.object);
        (self.skin_on_object).step(conductance, factors, skin_above_object);
        let closed_form = finger.closed_form_is_valid() || !follow_skin;
        contact.update_interpolation_due_and_conductances(
            finger,
            object_presented.pair,
            closed_form,
            follow_skin,
        );
        let interpolated = contact.interpolated_setpoint(
            finger,
            (skin, object),
            follow_skin,
            &mut self.evaluations,
        );
        let setpoint = interpolated.unwrap_or_else(|| {
            (self.skin_on_object).setpoint(factors, skin, skin_above_object, None)
        });
        let correction = match finger.stored_conductances() {
            Some(both) if follow_skin => (self.skin_on_object).skin_matching_correction(
                skin_state_on_display,
                &both.display,
                None,
            ),
            _ => Celsius::ZERO,
        };
        let target = setpoint.saturating_add(correction);
        // A skin that is followed tick by tick has its correction in the reported set-point, too.
        let setpoint = if closed_form { setpoint } else { target };
        Some(Reference::limited_to_safe_range(setpoint, target))
    }

    /// [`Self::next_reference`] in the mode with contact resistance for a finger and an object that are not both
    /// half-spaces, apart from the code of the thesis's. `skin` and `object` are the temperatures before contact, °C.
    #[inline(never)]
    fn next_reference_of_bodies(
        &mut self,
        before: &BodiesBeforeContact<'_>,
        (skin, object): (Celsius, Celsius),
        finger: &mut FingerEstimator,
        follow_skin: bool,
    ) -> Reference {
        let (contact, skin_state_on_display) = finger.contact_and_skin_state();
        self.contact = None;
        let ratio_at_landing = self.factors.ratio_at_landing;
        let Some(contact) = contact else {
            self.lead = SetpointLead::default();
            let mut changes = self.skin_on_object.step_bodies(None, before);
            if !follow_skin {
                return Reference::at(preset(ratio_at_landing, skin, object));
            }
            changes.cooling = skin_state_on_display.free_response();
            let setpoint = changes.setpoint(ratio_at_landing, skin, before.skin_above_object);
            let offset = if before.bodies.resistances.display_layer == U16F16::ZERO {
                waiting_offset_below_preset(skin, setpoint)
            } else {
                waiting_offset_below_layer(skin, setpoint, self.factors.weight)
            };
            return Reference::limited_to_safe_range(setpoint, setpoint.saturating_sub(offset));
        };
        let conductances = contact.stored_conductances();
        let changes =
            (self.skin_on_object).step_bodies(conductances.map(|both| &both.object), before);
        let ratio = conductances.map_or(ratio_at_landing, |both| both.ratio);
        let setpoint = changes.setpoint(ratio, skin, before.skin_above_object);
        let correction = match conductances {
            Some(both) if follow_skin => (self.skin_on_object).skin_matching_correction(
                skin_state_on_display,
                &both.display,
                Some(before.bodies),
            ),
            _ => Celsius::ZERO,
        };
        // A skin that is followed tick by tick has its correction in the reported set-point, too.
        let corrected = setpoint.saturating_add(correction);
        // Updated with the other laws, too, so that it is not outdated when `model` is selected during a contact.
        let lead = self.lead.next_lead(setpoint);
        let target = corrected.saturating_add(if follow_skin { lead } else { Celsius::ZERO });
        Reference::limited_to_safe_range(corrected, target)
    }
}

/// Whether the temperature of the display's surface, °C, is more than 0.1 K outside the range from the preset, °C, to
/// the temperature `waiting_offset`, K, below the preset. If so in the first tick of a contact, the law `model` does
/// not use the closed form of Eq. 6-12 for this contact.
fn is_display_outside_preset_to_waiting_range(
    surface: Celsius,
    preset: Celsius,
    waiting_offset: Celsius,
) -> bool {
    let half_offset = waiting_offset >> 1u32;
    let error = surface.saturating_sub(preset).saturating_add(half_offset);
    error.abs() > PRESET_TO_WAITING_RANGE_MARGIN.saturating_add(half_offset.abs())
}

#[cfg(test)]
mod tests;

//! The finger: its temperature before contact, its force, and by how much the display has cooled its skin.

use contact_model::fixed_point::{
    Body, Celsius, Contact, ContactConductance, ContactPair, Force, OwnResistances, Ratio,
    TissueStateFactors, contact_area, log2_relative_pressure, product, saturating_product,
};
use fixed::types::{I2F30, I10F22, U16F16};

use super::Watt;
use super::assumed_skin::AssumedSkin;
use super::force_means::{ForceChange, ForceMeans};
use super::skin_state::{Bodies, SkinState};

/// Time constant of the low-pass filters of skin and room temperature while no finger touches, as an exponent of two:
/// 2^8 ticks of 1 ms, 0.26 s.
const SKIN_AND_ROOM_FILTER_SHIFT: u32 = 8;
/// Ticks of 1 ms (2 s) after lifting during which the skin's thermistor still shows the cooling or warming by the
/// contact. During this time the filtered temperatures of skin and room stay, and for a contact that begins in this
/// time the law `model` does not use the closed-form set-point of Eq. 6-12.
const SKIN_RECOVERY_TICKS: u32 = 2000;
/// Ticks of 1 ms after landing during which a jump of the force is taken for the rise of the force at landing and only
/// starts the running means of the force again. After a later jump the law `model` does not use the closed-form
/// set-point of Eq. 6-12, which assumes a constant force, for the rest of the contact.
const LANDING_RISE_TICKS: u64 = 16;
/// Ticks of 1 ms after landing from which on the initial force of a contact is fixed; until then the initial force
/// equals the present mean force. The delay keeps most of the rise of the force at landing out of the initial force. If
/// a later mean force differs from the initial force by more than 1/64, the law `model` does not use the closed-form
/// set-point of Eq. 6-12 for the rest of the contact.
const INITIAL_FORCE_STORED_AFTER_TICKS: u64 = 64;
/// The force counts as constant while its mean stays within 1/64 (2^-6, this power of two) of the mean that it had
/// [`INITIAL_FORCE_STORED_AFTER_TICKS`] (64 ms) after landing. After a larger change the law `model` does not use the
/// closed-form set-point of Eq. 6-12 for the rest of the contact.
const CONSTANT_FORCE_TOLERANCE_SHIFT: u32 = 6;
/// The contact conductances are computed again when the mean force has changed by more than 1/1024 (2^-10, this power
/// of two) since they were computed. A smaller change of the force has no noticeable effect on the skin's temperature.
const CONDUCTANCE_FORCE_TOLERANCE_SHIFT: u32 = 10;
/// `e_skin / sqrt(dt)`, W/(K mm²), with the effusivity of the skin (1170 J/(m² K s^½)) and the tick `dt` of 1 ms.
/// [`HalfSpace`](contact_model::fixed_point::HalfSpace) represents a heat flux as a scaled flux, K; multiplied by this constant, the scaled flux is the heat
/// flux into the display in W/mm².
const SKIN_EFFUSIVITY_PER_ROOT_TICK_W_K_MM2: I2F30 = I2F30::from_bits(39_728_000);

/// A heat flux, W/mm², positive out of the skin.
pub type FluxPerMm2 = I10F22;

/// Low-pass filtered temperatures of the skin and of the room before a contact. They are not updated from landing until
/// 2 s after lifting, and not in the first 2 s after a restart of the estimator. The set-points of a contact are
/// computed from these initial temperatures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreContactTemperatures {
    /// Filtered temperature, °C, of the skin beside the area that touches the display, where the skin's thermistor is;
    /// while the host assumes a skin, the temperature that it assumes.
    pub skin: Celsius,
    /// Filtered temperature of the room, °C. It is also the initial temperature of the presented object if the host has
    /// not set one.
    pub room: Celsius,
}

/// Updates the filtered temperature `state` of skin or room by the reading `input` of one tick, all in °C. The time
/// constant is 2^[`SKIN_AND_ROOM_FILTER_SHIFT`] ticks of 1 ms (0.26 s).
pub(super) fn filter_skin_or_room(state: Celsius, input: Celsius) -> Celsius {
    state.saturating_add(input.saturating_sub(state) >> SKIN_AND_ROOM_FILTER_SHIFT)
}

/// Thermal contact conductances for one finger force, as scaled heat flux (K) per kelvin: of the real contact between
/// skin and display, and of the simulated contact between skin and presented object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactConductances {
    /// Force, N, for which the conductances were computed.
    force: Force,
    contact: Contact,
    /// Conductance between skin and display, as scaled heat flux (K) per kelvin; determines the heat that the finger
    /// really gives to the display.
    pub display: ContactConductance,
    /// Conductance between skin and presented object, as scaled heat flux (K) per kelvin; determines how much the
    /// simulated skin cools on the object.
    pub object: ContactConductance,
    /// Resistance between skin and display over that between skin and object, with the finger's own ones.
    pub ratio: Ratio,
}

impl ContactConductances {
    fn new(pair: &ContactPair, bodies: Option<&Bodies>, force: Force) -> Self {
        let pressure = log2_relative_pressure(force);
        let contact = match bodies {
            None => pair.at_pressure(pressure),
            Some(bodies) => bodies.resistances.contact(pair, pressure),
        };
        let (display, object) = match bodies {
            None => (contact.display_conductance(), contact.object_conductance()),
            Some(Bodies { finger, object, resistances, .. }) => (
                contact.display_conductance_of(&finger.tissue, resistances),
                contact.conductance_of(&finger.tissue, object, resistances),
            ),
        };
        let ratio = bodies.map_or(contact.ratio, |bodies| contact.ratio_of(&bodies.resistances));
        Self { force, contact, display, object, ratio }
    }

    /// Contact resistance of skin and display without the factor that was learnt, K per K of scaled flux; `own` are the finger's.
    pub fn expected_display_resistance(&self, own: &OwnResistances) -> U16F16 {
        self.contact.expected_display_resistance(own)
    }

    /// Whether the conductances may also be used for `force`, N, because it differs by at most 1/1024 from the force
    /// for which they were computed.
    fn are_valid_for_force(&self, force: Force) -> bool {
        force.abs_diff(self.force) <= self.force >> CONDUCTANCE_FORCE_TOLERANCE_SHIFT
    }
}

/// One contact of a finger with the display, from landing to lifting: force, time, and contact conductances. It
/// continues when the host presents another object; only the conductance between skin and object depends on the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FingerContact {
    force: ForceMeans,
    /// Whether the last tick's force was noise, showed a drift, or was a jump; `New` (a jump) at landing.
    change: ForceChange,
    /// Whether the closed-form set-point of Eq. 6-12 is valid for the contact; see [`Self::closed_form_is_valid`]. Once
    /// false, this stays false until the finger lifts.
    closed_form_applies: bool,
    /// Mean force of the contact, N, [`INITIAL_FORCE_STORED_AFTER_TICKS`] (64 ms) after landing; before that, the
    /// present mean. The force counts as constant while its mean stays within 1/64 of this value.
    initial_force: Force,
    /// Ticks of 1 ms since landing, when the force rose from zero (to 3 mN); landing counts as at most 32 ticks before
    /// the contact was detected.
    elapsed: u64,
    /// Contact conductances for a force within 1/1024 of the present mean force; `None` until a tick computes them, and
    /// after another object has been presented.
    conductances: Option<ContactConductances>,
    /// Flux by which a sensor has measured more than the model of the finger says.
    flux_beyond_model: FluxPerMm2,
}

impl FingerContact {
    /// Begins a contact in the tick in which it is detected, `landed_ticks` (2 to 32) ticks after the force rose from
    /// zero (to 3 mN); `force`, N, is the force in this tick. `skin_recovered` means that the estimator has run without
    /// contact for at least 2 s; else the closed-form set-point of Eq. 6-12 is not valid for the contact.
    fn new_at_contact_detection(force: Force, landed_ticks: u32, skin_recovered: bool) -> Self {
        Self {
            force: ForceMeans::new(force),
            change: ForceChange::New,
            closed_form_applies: skin_recovered,
            initial_force: force,
            elapsed: landed_ticks.into(),
            conductances: None,
            flux_beyond_model: FluxPerMm2::ZERO,
        }
    }

    /// Updates the contact by the force of one further tick, N, and decides whether the force is still constant enough
    /// for the closed-form set-point of Eq. 6-12.
    fn update_by_force(&mut self, force: Force) {
        self.change = self.force.add_force(force);
        self.elapsed += 1;
        let mean = self.force.long_mean();
        if self.elapsed < INITIAL_FORCE_STORED_AFTER_TICKS {
            self.initial_force = mean;
        }
        let drifted = mean.abs_diff(self.initial_force)
            > self.initial_force >> CONSTANT_FORCE_TOLERANCE_SHIFT;
        let changed = self.change == ForceChange::New && self.elapsed >= LANDING_RISE_TICKS;
        self.closed_form_applies &= !drifted && !changed;
    }

    /// Running means of this contact's force, N, which also hold the mean for which set-points are computed.
    pub const fn force_means(&self) -> &ForceMeans {
        &self.force
    }

    /// Whether the last tick's force was noise, showed a drift, or was a jump; a landing also counts as a jump. After a
    /// drift or a jump the reference generator computes its interpolation of the closed-form set-point (Eq. 6-12)
    /// again: with the law `model` only while the closed form is valid for the contact, with the other laws always.
    pub const fn force_change(&self) -> ForceChange {
        self.change
    }

    /// Ticks of 1 ms since landing, which is the tick in which the force rose from zero (to 3 mN), but at most 32 ticks
    /// before the contact was detected.
    pub const fn ticks_since_landing(&self) -> u64 {
        self.elapsed
    }

    /// Whether the closed-form set-point of Eq. 6-12, which assumes a first contact under constant force, is valid for
    /// this contact. It is valid if this estimator had run without contact for at least 2 s before landing, the display
    /// was near its preset temperature when the contact with the presented object began, the force has not jumped since
    /// 16 ms after landing, and the force's mean has stayed within 1/64 of its value 64 ms after landing. Otherwise,
    /// with the law `model`, the reference generator computes the set-point from the simulated skin on the object; with
    /// the other laws it uses the closed form in any case.
    pub const fn closed_form_is_valid(&self) -> bool {
        self.closed_form_applies
    }

    /// Makes the closed-form set-point of Eq. 6-12 invalid for the rest of this contact, so that the law `model` does
    /// not use it. The reference generator calls this in the first tick of a contact with the presented object if the
    /// surface of the display is then more than 0.1 K outside the range between two temperatures: the preset (the
    /// set-point before contact), and the temperature at which the law `model` keeps a waiting display, which is below
    /// the preset by 1/128 of the skin's temperature minus the preset.
    pub const fn exclude_closed_form(&mut self) {
        self.closed_form_applies = false;
    }

    /// Contact conductances for a force within 1/1024 of the present mean force. `None` if no tick has computed them
    /// since landing, or since another object was presented.
    pub const fn stored_conductances(&self) -> Option<&ContactConductances> {
        self.conductances.as_ref()
    }

    /// Makes the present mean force, N, the one for which set-points are computed, and computes the contact
    /// conductances for exactly this force. The reference generator calls this when its interpolation of the set-point
    /// (Eq. 6-12) must be computed. With the law `model` the interpolation then normally follows in the next tick, to
    /// spread the computing time over two ticks; with the other laws in the same tick.
    pub fn adopt_setpoint_force_and_conductances(&mut self, pair: &ContactPair) {
        self.force.use_long_mean_for_setpoints();
        if self.contact_if_computed_for_setpoint_force().is_none() {
            self.conductances =
                Some(ContactConductances::new(pair, None, self.force.mean_for_setpoints()));
        }
    }

    /// Parameters of the contact under exactly the force for which set-points are computed. `None` if the stored
    /// conductances were computed for another force or not at all; then the interpolation of the set-point (Eq. 6-12)
    /// cannot be computed in this tick.
    pub fn contact_if_computed_for_setpoint_force(&self) -> Option<&Contact> {
        let conductances = self.conductances.as_ref()?;
        (self.force.mean_for_setpoints() == conductances.force).then_some(&conductances.contact)
    }
}

/// Estimates the skin's temperature before contact, the force of the present contact, by how much the display has
/// cooled the skin, and the heat flow from the finger into the display, tick by tick. Runs under every control law, so
/// that the estimates are right when the host selects the law `model` during a contact.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FingerEstimator {
    /// Filtered temperatures of skin and room before contact, °C; `None` until a first tick with valid readings, also
    /// after `invalidate`.
    before_contact: Option<PreContactTemperatures>,
    /// Ticks of 1 ms without contact since the last contact ended, or since the estimator was started or invalidated; 0
    /// during contact. From 2000 (2 s) on, the temperatures of skin and room are filtered again.
    lifted_ticks: u32,
    contact: Option<FingerContact>,
    /// Thermal state of the skin. Its output is the cooling of the skin's surface, K, by the heat that the skin has
    /// given to the display: positive where the skin is colder than before contact. Decays to zero after lifting.
    skin_state_on_display: SkinState,
    /// The skin that the host assumes for set-points, to which `before_contact` and `skin_state_on_display` then belong,
    /// and the sensed skin beside it; `None` without an assumption.
    assumed_skin: Option<AssumedSkin>,
    /// Flux of the last tick into the display by the modelled finger.
    modelled_flux: FluxPerMm2,
    /// What was learnt of the error of the skin's thermistor, K: all temperatures of the sensed skin are by so much above its
    /// readings.
    skin_offset: Celsius,
}

impl FingerEstimator {
    /// Updates the finger's estimates by one tick's temperatures of skin and room, °C, and by the force `touch`, N,
    /// which is `None` without contact. In the first tick of a contact `landed_ticks` is the number of ticks since the
    /// force rose from zero (to 3 mN), at most 32; in all other ticks it is ignored.
    ///
    /// The first readings after a start or [`Self::invalidate`] set the temperatures of skin and room. Later readings
    /// are filtered only while no finger touches and there has been no contact for 2 s: during contact the skin's
    /// thermistor does not measure the undisturbed skin, and for some time afterwards it shows the cooling or warming
    /// by that contact. So the temperatures also stay for the first 2 s after a start or [`Self::invalidate`].
    pub fn update_by_readings(
        &mut self,
        skin: Celsius,
        room: Celsius,
        touch: Option<Force>,
        landed_ticks: u32,
    ) {
        let recovered = self.lifted_ticks >= SKIN_RECOVERY_TICKS;
        let is_undisturbed = touch.is_none() && recovered;
        let skin = skin.saturating_add(self.skin_offset);
        let skin = match &mut self.assumed_skin {
            None => skin,
            Some(assumed) => assumed.update_by_reading(skin, is_undisturbed),
        };
        self.before_contact = Some(match self.before_contact {
            None => PreContactTemperatures { skin, room },
            Some(before) if !is_undisturbed => before,
            Some(before) => PreContactTemperatures {
                skin: filter_skin_or_room(before.skin, skin),
                room: filter_skin_or_room(before.room, room),
            },
        });
        match (touch, &mut self.contact) {
            (None, contact) => *contact = None,
            (Some(force), contact @ None) => {
                *contact =
                    Some(FingerContact::new_at_contact_detection(force, landed_ticks, recovered));
            }
            (Some(force), Some(contact)) => contact.update_by_force(force),
        }
        self.lifted_ticks = match touch {
            Some(_) => 0,
            None => self.lifted_ticks.saturating_add(1),
        };
    }

    /// From now on takes `assumed`, °C, for the temperature of the skin before contact, also during a contact; the
    /// cooling by the contact so far stays. The heat into the display remains that of the sensed skin. With `None` all
    /// estimates become those without an assumption, also during a contact.
    pub fn assume_skin(&mut self, assumed: Option<Celsius>) {
        let skin = match assumed {
            Some(temperature) => {
                let sensed = AssumedSkin {
                    temperature,
                    sensed: self.before_contact.map(|before| before.skin),
                    sensed_state: self.skin_state_on_display,
                };
                self.assumed_skin.get_or_insert(sensed).temperature = temperature;
                Some(temperature)
            }
            None => self.assumed_skin.take().and_then(|assumed| {
                self.skin_state_on_display = assumed.sensed_state;
                assumed.sensed
            }),
        };
        if let (Some(before), Some(skin)) = (&mut self.before_contact, skin) {
            before.skin = skin;
        }
    }

    /// Discards the temperatures before contact, the contact, and the cooling of the skin; the next call of
    /// [`Self::update_by_readings`] starts from its readings. Assumed temperature and offset of the skin stay. Called in each
    /// tick whose readings are invalid or in which a fault detector finds a fault, because such a tick does not update
    /// the estimates, and a landing or lifting of the finger would be missed.
    pub fn invalidate(&mut self) {
        let assumed = self.assumed_skin.as_ref().map(|skin| skin.temperature);
        *self = Self { skin_offset: self.skin_offset, ..Self::default() };
        self.assume_skin(assumed);
    }

    /// Filtered temperatures of skin and room, °C: those before the present or last contact, or, once no finger has
    /// touched for 2 s, the present ones. `None` until a first tick with valid readings, also after
    /// [`Self::invalidate`].
    pub const fn temperatures_before_contact(&self) -> Option<PreContactTemperatures> {
        self.before_contact
    }

    /// The present contact; `None` while no finger touches, and after [`Self::invalidate`] until the next valid
    /// readings.
    pub const fn contact(&self) -> Option<&FingerContact> {
        self.contact.as_ref()
    }

    /// Two values. First, the present contact, or `None` while no finger touches; it is mutable, because the reference
    /// generator chooses the force for which set-points are computed. Second, the thermal state of the skin, whose
    /// output is the cooling of the skin's surface by the display, K: positive where the skin is colder than before
    /// contact.
    pub const fn contact_and_skin_state(&mut self) -> (Option<&mut FingerContact>, &SkinState) {
        (self.contact.as_mut(), &self.skin_state_on_display)
    }

    /// Thermal state of the skin on the display. Its output is the cooling of the skin's surface, K, by the contact
    /// with the display so far: positive where the skin is colder than before contact, negative where the display has
    /// warmed it. Decays to zero after lifting.
    pub const fn skin_state_on_display(&self) -> &SkinState {
        &self.skin_state_on_display
    }

    /// Temperature of the skin before contact, °C, as its thermistor has it; `None` as [`Self::temperatures_before_contact`].
    pub fn skin_before_contact_by_thermistor(&self) -> Option<Celsius> {
        let sensed = match &self.assumed_skin {
            None => self.before_contact.map(|before| before.skin),
            Some(assumed) => assumed.sensed,
        };
        sensed.map(|skin| skin.saturating_sub(self.skin_offset))
    }

    /// Takes the sensed skin to be by `offset`, K, warmer than its thermistor, at once and from now on.
    pub fn set_skin_offset(&mut self, offset: Celsius) {
        let change = offset.saturating_sub(self.skin_offset);
        self.skin_offset = offset;
        let sensed = match &mut self.assumed_skin {
            None => self.before_contact.as_mut().map(|before| &mut before.skin),
            Some(assumed) => assumed.sensed.as_mut(),
        };
        if let Some(skin) = sensed {
            *skin = skin.saturating_add(change);
        }
    }

    /// Flux of the last tick into the display by the modelled finger; 0 without contact.
    pub fn modelled_flux(&self) -> FluxPerMm2 {
        (self.contact.as_ref()).map_or(FluxPerMm2::ZERO, |_| self.modelled_flux)
    }

    /// Adds this to the flux of the modelled finger until another follows, or this contact ends.
    pub const fn set_flux_beyond_model(&mut self, flux: FluxPerMm2) {
        if let Some(contact) = &mut self.contact {
            contact.flux_beyond_model = flux;
        }
    }

    /// Makes the skin's states those that the heat so far would have made in the tissue `to`.
    pub fn change_tissue(&mut self, factors: &TissueStateFactors, to: &Body) {
        self.skin_state_on_display.change_tissue(factors, to);
        if let Some(assumed) = &mut self.assumed_skin {
            assumed.sensed_state.change_tissue(factors, to);
        }
    }

    /// Makes the skin's tissue uniform, as if it had recovered, because another tissue is assumed from now on.
    pub fn forget_tissue_history(&mut self) {
        self.skin_state_on_display.forget_tissue_history();
        if let Some(assumed) = &mut self.assumed_skin {
            assumed.sensed_state.forget_tissue_history();
        }
    }

    /// Discards the contact conductances of the present contact, if there is one, because the host presents another
    /// object. The next tick that needs them computes them for the new object.
    pub const fn forget_conductances(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.conductances = None;
        }
    }

    /// Advances the thermal state of the skin by one tick, in contact with a display whose surface has the temperature
    /// `surface`, °C, or without contact. Returns the heat flow from the finger into the display, W: negative if the
    /// display is warmer than the skin's surface, 0 without contact. It is the flow out of the sensed skin, also while another
    /// skin is assumed, plus the flux set by [`Self::set_flux_beyond_model`] over the contact's area. Computes the contact
    /// conductances again if the mean force has changed by more than 1/1024. Of `pair` only the properties of skin and display
    /// matter here, so the caller may give a pair with any object.
    pub fn step_skin_heat_flow(
        &mut self,
        pair: &ContactPair,
        bodies: &Bodies,
        surface: Celsius,
    ) -> Watt {
        let Some(before) = self.before_contact else {
            return Watt::ZERO;
        };
        let (force, beyond, display) = match &mut self.contact {
            None => (Force::ZERO, FluxPerMm2::ZERO, None),
            Some(contact) => {
                let force = contact.force.long_mean();
                let conductances = match &mut contact.conductances {
                    Some(conductances) if conductances.are_valid_for_force(force) => conductances,
                    outdated => {
                        let bodies = (!bodies.are_half_spaces).then_some(bodies);
                        outdated.insert(ContactConductances::new(pair, bodies, force))
                    }
                };
                let beyond = contact.flux_beyond_model;
                (force, beyond, Some(&conductances.display))
            }
        };
        let mut scaled_flux =
            (self.skin_state_on_display).step_on_display(display, bodies, &before, surface);
        if let Some(assumed) = &mut self.assumed_skin {
            scaled_flux = assumed.step_sensed_skin(display, bodies, before.room, surface);
        }
        self.modelled_flux = product(scaled_flux, SKIN_EFFUSIVITY_PER_ROOT_TICK_W_K_MM2);
        let flux = self.modelled_flux.saturating_add(beyond);
        saturating_product(flux, contact_area(force))
    }
}

#[cfg(test)]
mod tests;

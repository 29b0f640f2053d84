//! The finger: its temperature before contact, its force, and how far its skin has cooled on the display.

use contact_model::fixed_point::{
    Celsius, Contact, ContactConductance, ContactPair, Force, HalfSpace, contact_area,
    log2_relative_pressure, product, saturating_product,
};
use fixed::types::{I2F30, I10F22};

use super::Watt;
use super::force_mean::{ForceChange, ForceMean};

/// Time constant, as a power of two of ticks of 1 ms (0.26 s), of the low-pass filters of skin and room temperature
/// while no finger touches.
const BEFORE_CONTACT_FILTER_SHIFT: u32 = 8;
/// Ticks (2 s) without contact until the skin's thermistor reads the skin again, and not the cold or warmth that the
/// last contact has left. Until then skin and room temperature keep their values from before that contact, and a new
/// contact does not count as the first one.
const SKIN_RECOVERY_TICKS: u32 = 2000;
/// Ticks (16 ms) after landing in which a jump of the force counts as part of the landing. A jump after that ends the
/// use of the closed form of Eq. 6-12, which assumes a constant force.
const LANDING_RISE_TICKS: u64 = 16;
/// Ticks (64 ms) after landing at whose end the mean force is stored as the force of this contact. The recent mean
/// covers 64 ticks, so it then no longer contains the rise.
const RISEN_FORCE_TICKS: u64 = 64;
/// The force counts as constant while its mean stays within 1/64 (this power of two) of the mean of
/// [`RISEN_FORCE_TICKS`] after landing. Beyond that the closed form of Eq. 6-12 is no longer used.
const CONSTANT_FORCE_SHIFT: u32 = 6;
/// Contact conductances are kept while the mean force stays within 1/1024 (this power of two) of the force that they
/// were computed for; the skin's temperature would not differ noticeably.
const CONDUCTANCE_REUSE_SHIFT: u32 = 10;
/// `e_skin / sqrt(dt)`, W/(K mm²), with the skin's effusivity and the tick of 1 ms: heat flux into the display for 1 K
/// of the scaled flux in which [`HalfSpace`] counts.
const EFFUSIVITY_PER_ROOT_TICK_W_K_MM2: I2F30 = I2F30::from_bits(39_728_000);

/// Temperatures of skin and room while the finger does not touch, low-pass filtered. They are frozen from landing until
/// 2 s after lifting, and every set-point of the contact starts from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreContactTemperatures {
    /// Temperature of the skin at the edge of the contact, °C.
    pub skin: Celsius,
    /// Temperature of the room, °C; also that of the presented object if the host has set none.
    pub room: Celsius,
}

/// One tick of the filter with the time constant 2^[`BEFORE_CONTACT_FILTER_SHIFT`] ticks: the new filtered temperature,
/// °C.
fn filtered_before_contact(state: Celsius, input: Celsius) -> Celsius {
    state.saturating_add(input.saturating_sub(state) >> BEFORE_CONTACT_FILTER_SHIFT)
}

/// The two thermal contact conductances, W/(m² K), of one finger force: of the real contact between skin and display,
/// and of the simulated contact between skin and presented object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactConductances {
    /// Force, N, for which the conductances were computed.
    force: Force,
    contact: Contact,
    /// Conductance between skin and display, which determines the heat that the finger really gives.
    pub display: ContactConductance,
    /// Conductance between skin and presented object, which determines how the skin would cool on the object.
    pub object: ContactConductance,
}

impl ContactConductances {
    fn new(pair: &ContactPair, force: Force) -> Self {
        let contact = pair.at_pressure(log2_relative_pressure(force));
        Self {
            force,
            contact,
            display: contact.display_conductance(),
            object: contact.object_conductance(),
        }
    }

    /// Whether the conductances may be used for `force`, too, because it differs by at most 1/1024 from the force that
    /// they were computed for.
    fn are_accurate_for(&self, force: Force) -> bool {
        force.abs_diff(self.force) <= self.force >> CONDUCTANCE_REUSE_SHIFT
    }
}

/// One contact of a finger with the display, from landing to lifting: force, time, and contact conductances. It does
/// not depend on the presented object, except for the conductance between skin and object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FingerContact {
    force: ForceMean,
    /// Result of the last tick's comparison of the force with its mean; `New` at landing.
    change: ForceChange,
    /// Whether the closed form of Eq. 6-12 describes the contact; see [`Self::has_closed_form`]. Once false, it stays
    /// false until the finger lifts.
    constant: bool,
    /// Mean force, N, at the end of the rise, [`RISEN_FORCE_TICKS`] after landing; until then the present mean.
    risen_force: Force,
    /// Ticks of 1 ms since the finger landed.
    elapsed: u64,
    /// Conductances under the present force; `None` until the first tick that needs them, and after the object has
    /// changed.
    conductances: Option<ContactConductances>,
}

impl FingerContact {
    /// The contact in the tick in which it is detected, `landed_ticks` after the force left its zero. `skin_recovered`:
    /// the last contact ended 2 s ago or earlier.
    fn at_landing(force: Force, landed_ticks: u32, skin_recovered: bool) -> Self {
        Self {
            force: ForceMean::new(force),
            change: ForceChange::New,
            constant: skin_recovered,
            risen_force: force,
            elapsed: landed_ticks.into(),
            conductances: None,
        }
    }

    /// Takes the force of one further tick of the contact, N, and decides whether the contact still has the closed
    /// form.
    fn update_force(&mut self, force: Force) {
        self.change = self.force.add_tick(force);
        self.elapsed += 1;
        let mean = self.force.mean();
        if self.elapsed < RISEN_FORCE_TICKS {
            self.risen_force = mean;
        }
        let drifted = mean.abs_diff(self.risen_force) > self.risen_force >> CONSTANT_FORCE_SHIFT;
        let changed = self.change == ForceChange::New && self.elapsed >= LANDING_RISE_TICKS;
        self.constant &= !drifted && !changed;
    }

    /// The running mean of the force, N, and the mean for which set-points are computed.
    #[must_use]
    pub const fn force_mean(&self) -> &ForceMean {
        &self.force
    }

    /// How the last tick's force compares with its mean: noise, drift, or a new force. The reference generator rebuilds
    /// its interpolation after the last two.
    #[must_use]
    pub const fn force_change(&self) -> ForceChange {
        self.change
    }

    /// Ticks of 1 ms since the force left its zero at landing.
    #[must_use]
    pub const fn ticks_since_landing(&self) -> u64 {
        self.elapsed
    }

    /// Whether Eq. 6-12 in closed form describes the contact. It does if the last contact ended at least 2 s before
    /// landing, the display was at its preset at landing, and the force has been constant within 1/64 since it had
    /// risen. Otherwise the reference generator integrates the heat flow tick by tick.
    #[must_use]
    pub const fn has_closed_form(&self) -> bool {
        self.constant
    }

    /// Excludes the closed form of Eq. 6-12 for the rest of this contact, because the display was not near its preset
    /// temperature at landing. Called by the reference generator in the first tick of a contact.
    pub const fn note_late_display(&mut self) {
        self.constant = false;
    }

    /// Contact conductances for the present force, within 1/1024; `None` if no tick of the contact has computed them
    /// since landing or since the object changed.
    #[must_use]
    pub const fn conductances(&self) -> Option<&ContactConductances> {
        self.conductances.as_ref()
    }

    /// Makes the present mean force, N, the one for which set-points are computed, and computes the contact
    /// conductances for exactly this force. The reference generator calls it one tick before it rebuilds its
    /// interpolation, so that no tick pays for both.
    pub fn use_mean_force(&mut self, pair: &ContactPair) {
        self.force.use_present_mean();
        if self.contact_at_force_in_use().is_none() {
            self.conductances = Some(ContactConductances::new(pair, self.force.mean_in_use()));
        }
    }

    /// Parameters of the simulated contact under exactly the force for which set-points are computed. `None` if the
    /// stored conductances belong to another force; then the interpolation of Eq. 6-12 cannot be rebuilt in this tick.
    #[must_use]
    pub fn contact_at_force_in_use(&self) -> Option<&Contact> {
        let conductances = self.conductances.as_ref()?;
        (self.force.mean_in_use() == conductances.force).then_some(&conductances.contact)
    }
}

/// Estimates, tick by tick, the skin's temperature before contact, the force of the present contact, and how far the
/// skin has cooled on the display. Runs with every control law, because the host may change the law while a finger
/// touches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FingerEstimator {
    /// `None` before the first valid readings.
    before_contact: Option<PreContactTemperatures>,
    /// Ticks of 1 ms since the last contact ended, or since the estimator started; 0 during contact.
    lifted_ticks: u32,
    /// The present contact; `None` while no finger touches.
    contact: Option<FingerContact>,
    /// Temperature change of the skin's surface, K, by the heat that it has given to the display; decays to zero after
    /// lifting.
    skin_on_display: HalfSpace,
}

impl FingerEstimator {
    /// Takes one tick's temperatures of skin and room, °C, and the force `touch`, N, which is `None` without contact.
    /// In the first tick of a contact `landed_ticks` is the time since the force left its zero; otherwise it is
    /// ignored.
    ///
    /// Skin and room are filtered only while no finger touches and the last contact ended 2 s ago or earlier: in
    /// contact the skin's thermistor sees little of the skin, and for some time afterwards what the contact has left.
    pub fn observe(
        &mut self,
        skin: Celsius,
        room: Celsius,
        touch: Option<Force>,
        landed_ticks: u32,
    ) {
        let recovered = self.lifted_ticks >= SKIN_RECOVERY_TICKS;
        self.before_contact = Some(match self.before_contact {
            None => PreContactTemperatures { skin, room },
            Some(before) if touch.is_some() || !recovered => before,
            Some(before) => PreContactTemperatures {
                skin: filtered_before_contact(before.skin, skin),
                room: filtered_before_contact(before.room, room),
            },
        });
        match (touch, &mut self.contact) {
            (None, contact) => *contact = None,
            (Some(force), contact @ None) => {
                *contact = Some(FingerContact::at_landing(force, landed_ticks, recovered));
            }
            (Some(force), Some(contact)) => contact.update_force(force),
        }
        self.lifted_ticks = match touch {
            Some(_) => 0,
            None => self.lifted_ticks.saturating_add(1),
        };
    }

    /// Forgets temperatures, contact and cooling of the skin; the next call of [`Self::observe`] starts from its
    /// readings. Called in a tick whose readings are invalid, because then the finger may have landed or lifted unseen.
    pub fn invalidate(&mut self) {
        *self = Self::default();
    }

    /// Skin and room temperature before the present or the next contact; `None` until a tick has had valid readings.
    #[must_use]
    pub const fn temperatures_before_contact(&self) -> Option<PreContactTemperatures> {
        self.before_contact
    }

    /// The present contact; `None` while no finger touches.
    #[must_use]
    pub const fn contact(&self) -> Option<&FingerContact> {
        self.contact.as_ref()
    }

    /// The present contact, to be changed by the reference generator, which chooses the force for which set-points are
    /// computed; and the temperature change of the skin's surface on the display, K.
    pub const fn contact_and_skin_on_display(
        &mut self,
    ) -> (Option<&mut FingerContact>, &HalfSpace) {
        (self.contact.as_mut(), &self.skin_on_display)
    }

    /// Temperature change of the skin's surface, K, that the contact with the display has caused so far; negative where
    /// the display has cooled the skin.
    #[must_use]
    pub const fn skin_on_display(&self) -> &HalfSpace {
        &self.skin_on_display
    }

    /// Discards the contact conductances of a finger that touches, because another object is presented; the next tick
    /// that needs them computes them for the new object.
    pub const fn forget_conductances(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.conductances = None;
        }
    }

    /// Advances the skin by one tick on a display whose surface has the temperature `surface`, °C. Returns the heat
    /// flow from the finger into the display, W, negative if the display is warmer than the skin, 0 without contact.
    /// `pair` is that of finger and presented object, or of any object if the host has chosen none.
    pub fn heat_into_display(&mut self, pair: &ContactPair, surface: Celsius) -> Watt {
        let Some(PreContactTemperatures { skin, .. }) = self.before_contact else {
            return Watt::ZERO;
        };
        let Some(contact) = &mut self.contact else {
            self.skin_on_display.step(Celsius::ZERO);
            return Watt::ZERO;
        };
        let force = contact.force.mean();
        let conductances = match &mut contact.conductances {
            Some(conductances) if conductances.are_accurate_for(force) => conductances,
            outdated => outdated.insert(ContactConductances::new(pair, force)),
        };
        let scaled_flux = conductances
            .display
            .scaled_flux(skin.saturating_sub(surface), &self.skin_on_display);
        self.skin_on_display.step(scaled_flux);
        let flux_w_mm2: I10F22 = product(scaled_flux, EFFUSIVITY_PER_ROOT_TICK_W_K_MM2);
        saturating_product(flux_w_mm2, contact_area(force))
    }
}

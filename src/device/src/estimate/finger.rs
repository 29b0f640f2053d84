//! The finger: its temperature before contact, its force, and how far its skin has cooled on the display.

use contact_model::fixed_point::{
    Celsius, Contact, ContactConductance, ContactPair, Force, HalfSpace, contact_area,
    log2_relative_pressure, product, saturating_product,
};
use fixed::types::{I2F30, I10F22};

use super::Watt;
use super::force_mean::{ForceChange, ForceMean};

/// Time constant of the filters before contact, as a power of two of ticks (0.26 s).
const BEFORE_CONTACT_FILTER_SHIFT: u32 = 8;
/// Ticks after a contact until the skin's thermistor reads the skin again, and not what the contact has left.
const SKIN_RECOVERY_TICKS: u32 = 2000;
/// Ticks after landing in which a rising force still counts as constant.
const LANDING_RISE_TICKS: u64 = 16;
/// Ticks after which the mean of a constant force no longer contains its rise; from then on it stays within this part of
/// itself, as a power of two.
const RISEN_FORCE_TICKS: u64 = 64;
const CONSTANT_FORCE_SHIFT: u32 = 6;
/// Relative change of a force, as a power of two, below which the skin's temperature does not change noticeably.
const CONDUCTANCE_REUSE_SHIFT: u32 = 10;
/// Heat flow per area and temperature difference of one tick, `e_skin / sqrt(dt)`, W/(K mm²).
const EFFUSIVITY_PER_ROOT_TICK_W_K_MM2: I2F30 = I2F30::from_bits(39_728_000);

/// Temperatures from which a contact starts, filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreContactTemperatures {
    /// Temperature of the skin, °C.
    pub skin: Celsius,
    /// Temperature of the room, °C.
    pub room: Celsius,
}

fn filtered_before_contact(state: Celsius, input: Celsius) -> Celsius {
    state.saturating_add(input.saturating_sub(state) >> BEFORE_CONTACT_FILTER_SHIFT)
}

/// How well heat flows between skin and display, and between skin and object, under one force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactConductances {
    force: Force,
    contact: Contact,
    /// Conductance between skin and display.
    pub display: ContactConductance,
    /// Conductance between skin and object.
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

    /// Whether they hold for a force, too: the skin's temperature would not differ noticeably.
    fn are_accurate_for(&self, force: Force) -> bool {
        force.abs_diff(self.force) <= self.force >> CONDUCTANCE_REUSE_SHIFT
    }
}

/// A finger that touches the display, whatever is presented to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FingerContact {
    force: ForceMean,
    change: ForceChange,
    /// The contact is the first one of a recovered skin, and its force has not changed since landing.
    constant: bool,
    /// Mean force at the end of its rise.
    risen_force: Force,
    /// Ticks since the finger landed.
    elapsed: u64,
    conductances: Option<ContactConductances>,
}

impl FingerContact {
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

    /// The force, averaged while it is constant, N.
    #[must_use]
    pub const fn force_mean(&self) -> &ForceMean {
        &self.force
    }

    /// How this tick's force differs from those before.
    #[must_use]
    pub const fn force_change(&self) -> ForceChange {
        self.change
    }

    /// Ticks since the finger landed.
    #[must_use]
    pub const fn ticks_since_landing(&self) -> u64 {
        self.elapsed
    }

    /// Whether the closed form of Eq. 6-12 describes the contact: it is the first of a recovered skin, under a force that
    /// has not changed.
    #[must_use]
    pub const fn has_closed_form(&self) -> bool {
        self.constant
    }

    /// The closed form does not describe this contact, because the display was not at its preset at landing.
    pub const fn note_late_display(&mut self) {
        self.constant = false;
    }

    /// Conductances under the present force.
    #[must_use]
    pub const fn conductances(&self) -> Option<&ContactConductances> {
        self.conductances.as_ref()
    }

    /// Evaluates set-points for the mean force from now on.
    pub fn use_mean_force(&mut self, pair: &ContactPair) {
        self.force.use_present_mean();
        if self.contact_at_force_in_use().is_none() {
            self.conductances = Some(ContactConductances::new(pair, self.force.mean_in_use()));
        }
    }

    /// The contact under exactly the force in use, if it is the one whose conductances are known.
    #[must_use]
    pub fn contact_at_force_in_use(&self) -> Option<&Contact> {
        let conductances = self.conductances.as_ref()?;
        (self.force.mean_in_use() == conductances.force).then_some(&conductances.contact)
    }
}

/// Estimates skin and force from tick to tick, whatever the control law, which may change under a finger.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FingerEstimator {
    before_contact: Option<PreContactTemperatures>,
    /// Ticks since the last contact.
    lifted_ticks: u32,
    contact: Option<FingerContact>,
    /// How far the skin's surface has cooled on the display.
    skin_on_display: HalfSpace,
}

impl FingerEstimator {
    /// Takes a tick's skin, room and force (`None` without contact); a contact that begins has begun `landed_ticks` ago.
    ///
    /// Skin and room are followed before contact only: during contact the skin's thermistor sees little of the skin, and for
    /// some time afterwards what the contact has left.
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

    /// Starts again from the next tick, because the finger was not observed.
    pub fn invalidate(&mut self) {
        *self = Self::default();
    }

    /// Skin and room before contact; `None` until they were observed.
    #[must_use]
    pub const fn temperatures_before_contact(&self) -> Option<PreContactTemperatures> {
        self.before_contact
    }

    /// The contact, if a finger touches.
    #[must_use]
    pub const fn contact(&self) -> Option<&FingerContact> {
        self.contact.as_ref()
    }

    /// The contact, for the reference generator, which decides for which force it evaluates set-points; and how far the
    /// skin's surface has cooled on the display.
    pub const fn contact_and_skin_on_display(
        &mut self,
    ) -> (Option<&mut FingerContact>, &HalfSpace) {
        (self.contact.as_mut(), &self.skin_on_display)
    }

    /// How far the skin's surface has cooled on the display.
    #[must_use]
    pub const fn skin_on_display(&self) -> &HalfSpace {
        &self.skin_on_display
    }

    /// Computes the conductances again before their next use, because another object is presented.
    pub const fn forget_conductances(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.conductances = None;
        }
    }

    /// Advances the skin by one tick on a display with this surface temperature; returns the heat that flows into the
    /// display, W. `pair` is that of the presented object, or of any object if none is presented.
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

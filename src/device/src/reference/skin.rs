//! The skin twice: as it is on the display, and as it would be on the object.
//!
//! Both are followed from the heat that has flowed through them, whatever force, timing and limits did to it. From
//! them follow Eq. 6-12 where its closed form does not hold (a changing force, a second contact), the finger's load on
//! the display, and what is missing when the skin is not where it should be.

use contact_model::fixed_point::{
    Celsius, Contact, ContactConductance, ContactPair, Force, Fraction, HalfSpace, Ratio,
    log2_relative_pressure,
};

/// Part of a force, as a power of two, by which it changes nothing that the skin could tell.
const SAME_SHIFT: u32 = 10;

/// The two skins, and the object under one of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Skin {
    /// How far each has cooled at its surface.
    on_display: HalfSpace,
    on_object: HalfSpace,
    /// What flows on the object in this tick.
    drive: Celsius,
}

/// How the skin touches under a force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Links {
    force: Force,
    contact: Contact,
    display: ContactConductance,
    object: ContactConductance,
}

impl Links {
    /// Of a pair.
    #[must_use]
    pub fn new(pair: &ContactPair, force: Force) -> Self {
        let contact = pair.at_pressure(log2_relative_pressure(force));
        Self {
            force,
            contact,
            display: contact.display_conductance(),
            object: contact.object_conductance(),
        }
    }

    /// Whether they do for a force: the skin could not tell it from theirs.
    #[must_use]
    pub fn do_for(&self, force: Force) -> bool {
        force.abs_diff(self.force) <= self.force >> SAME_SHIFT
    }

    /// Their contact, if it is that under exactly this force.
    #[must_use]
    pub fn contact_under(&self, force: Force) -> Option<&Contact> {
        (force == self.force).then_some(&self.contact)
    }
}

/// The materials between which heat flows; none between those of the default, whatever the inverse says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bodies {
    /// `e_object / (e_object + e_skin)`.
    weight: Fraction,
    /// Its inverse, 2^-16.
    inverse_weight: u32,
    /// `R_display / R_object`.
    ratio: Ratio,
}

impl Bodies {
    /// Of a pair.
    #[must_use]
    pub fn new(pair: &ContactPair) -> Self {
        let inverse = (1u64 << 48) / u64::from(pair.weight().to_bits().max(1));
        Self {
            weight: pair.weight(),
            inverse_weight: inverse.min(u64::from(u32::MAX)) as u32,
            ratio: pair.ratio(),
        }
    }

    /// Whether they are those of a pair.
    #[must_use]
    pub fn are_of(&self, pair: &ContactPair) -> bool {
        self.weight == pair.weight() && self.ratio == pair.ratio()
    }
}

fn limited(bits: i64) -> Celsius {
    Celsius::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
}

impl Skin {
    /// A new object, at rest; the skin stays as it is.
    pub fn forget_object(&mut self) {
        self.on_object = self.on_display.staggered();
        self.drive = Celsius::ZERO;
    }

    /// One tick on the display, whose surface is `display`; gives the drive into it. `before` is the skin's
    /// temperature when no heat has flowed for long.
    pub fn touch_display(
        &mut self,
        links: Option<&Links>,
        before: Celsius,
        display: Celsius,
    ) -> Celsius {
        let drive = links.map_or(Celsius::ZERO, |links| {
            links
                .display
                .scaled_flux(before.saturating_sub(display), &self.on_display)
        });
        self.on_display.step(drive);
        drive
    }

    /// One tick on the object.
    pub fn touch_object(&mut self, links: Option<&Links>, bodies: &Bodies, apart: Celsius) {
        self.drive = links.map_or(Celsius::ZERO, |links| {
            let in_front = (i64::from(apart.to_bits()) * i64::from(bodies.weight.to_bits())) >> 32;
            links.object.scaled_flux(limited(in_front), &self.on_object)
        });
        self.on_object.step(self.drive);
    }

    /// Eq. 6-12 from the skin on the object as it is now: `before` and `apart` are the skin's temperature before all
    /// contact and how much warmer than the object it was.
    #[must_use]
    pub fn display(
        &self,
        bodies: &Bodies,
        before: Celsius,
        apart: Celsius,
        touching: bool,
    ) -> Celsius {
        let moved = self.on_object.response_to(self.drive);
        let closed = (i64::from(moved.to_bits()) * i64::from(bodies.inverse_weight)) >> 16;
        // Within 512 K, so that the product has 63 bits.
        let step = limited(i64::from(apart.to_bits()) - closed).to_bits();
        let over_display =
            (i64::from(step) * i64::from(bodies.ratio.to_bits())) >> Ratio::FRAC_NBITS;
        // Between contacts it is this finger that will land.
        let skin = if touching {
            moved
        } else {
            self.on_display.free_response()
        };
        limited(i64::from(before.to_bits()) - i64::from(skin.to_bits()) - over_display)
    }

    /// What the display has to be off that, for the skin on it to come to where it should be.
    #[must_use]
    pub fn correction(&self, links: &Links) -> Celsius {
        links
            .display
            .temperature_drop(self.on_display.scaled_flux_to_match(&self.on_object))
            .saturating_neg()
    }
}

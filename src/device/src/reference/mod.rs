//! Scene to set-point: what the display should feel like, now.
//!
//! Before contact the display is preset to Eq. 6-12 at `t = 0`, from the skin's and the object's
//! temperatures; from landing on it follows Eq. 6-12; when the finger lifts it is preset again. In the
//! semi-infinite mode (chapter 4 of the thesis) it holds the interface temperature of Eq. 3-1 throughout.

mod force_mean;
mod skin;

use core::ops::RangeInclusive;

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, Contact, ContactPair, Force, contact_area,
};

use force_mean::{Change, ForceMean, all_the_same};
use skin::{Bodies, Links, Skin};

use crate::control::Watt;

/// How far the set-point may be from Eq. 6-12 at the force for which contact resistance was computed. What
/// is left to noise of the force makes this 0.5 mK.
pub const TOLERANCE: Celsius = Celsius::lit("0.0004");

/// Time constant of the filters before contact, as a power of two of ticks (0.26 s).
const FILTER_SHIFT: u32 = 8;

/// A skin that was touched is believed again after this many ticks: until then its sensor sees what the contact left.
const RESTED_TICKS: u32 = 2000;
/// A force may still rise for this many ticks after landing and count as constant.
const SETTLED_TICKS: u64 = 16;
/// The mean of a constant force has forgotten its rise after this many ticks, and then stays within this part of itself,
/// as a power of two.
const MEAN_TICKS: u64 = 64;
const CONSTANT_SHIFT: u32 = 6;
/// A display this far from its preset at landing was not in time.
const LATE: Celsius = Celsius::lit("0.1");
/// `e_skin / sqrt(dt)` per mm², W/K in 2^-30: what a drive of one kelvin carries.
const FLUX_W_MM2K: u32 = 39_728_000;

/// Which model gives the set-point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Eq. 6-12: contact resistance, follows the contact.
    #[default]
    ContactResistance,
    /// Eq. 3-1: perfect contact, constant.
    SemiInfinite,
}

/// What the host asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene<'a> {
    /// The material.
    pub pair: &'a ContactPair,
    /// Its temperature; that of the room if none was given.
    pub object: Option<Celsius>,
    /// Model.
    pub mode: Mode,
}

/// Temperatures from which a contact starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Before {
    skin: Celsius,
    room: Celsius,
}

/// First-order filter of `FILTER_SHIFT`.
fn filter(state: Celsius, input: Celsius) -> Celsius {
    state.saturating_add(input.saturating_sub(state) >> FILTER_SHIFT)
}

/// How the finger holds on, whatever it holds on to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Grip {
    force: ForceMean,
    /// What the last tick brought.
    change: Change,
    /// The first touch of a rested skin, and its force has not changed since.
    steady: bool,
    /// Its mean once it had risen.
    risen: Force,
    /// Ticks since landing.
    elapsed: u64,
    links: Option<Links>,
}

impl Grip {
    /// What is in use from now on is the mean force.
    fn use_mean(&mut self, pair: &ContactPair) {
        self.force.take();
        if self.contact_in_use().is_none() {
            self.links = Some(Links::new(pair, self.force.in_use()));
        }
    }

    /// The contact under the force in use, if that is known.
    fn contact_in_use(&self) -> Option<&Contact> {
        self.links.as_ref()?.contact_under(self.force.in_use())
    }
}

/// A contact with an object that lasts.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Touching {
    /// Ticks since it began.
    elapsed: u64,
    /// Forces for which contact resistance need not be computed again.
    same: RangeInclusive<Force>,
    /// Eq. 6-12 in closed form, if that holds.
    course: Option<ChordInterpolation>,
    /// It is to be laid, for the force in use. What that needs of the force is computed a tick before.
    due: bool,
}

/// What the display should do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Eq. 6-12.
    pub setpoint: Celsius,
    /// The same, and what brings the skin back to where the object would have it.
    pub target: Celsius,
}

/// Follows skin and contact; gives the wanted display temperature.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Render {
    /// Skin and room before contact, filtered.
    before: Option<Before>,
    /// Ticks for which nothing has touched.
    lifted_ticks: u32,
    grip: Option<Grip>,
    skin: Skin,
    /// Of the scene that was last presented.
    bodies: Bodies,
    touching: Option<Touching>,
    evaluations: u32,
}

/// How far off its set-point a display waits, away from the skin, for a finger to land: the bridge takes away in the
/// first 50 ms what the finger brings in the first 10, and half of that in advance halves its trace on the skin. That is
/// in proportion to the flux, whatever the material, and so to how much warmer than the display the skin is.
fn landing(skin: Celsius, setpoint: Celsius) -> Celsius {
    const LANDING_SHIFT: u32 = 7;
    skin.saturating_sub(setpoint) >> LANDING_SHIFT
}

impl Render {
    /// Follows skin, room and force, of which a contact that begins began `landed_ticks` ago. Temperatures before
    /// contact only: the skin's sensor sees little of it during contact, and for some time after it what the contact
    /// left.
    pub fn observe(
        &mut self,
        skin: Celsius,
        room: Celsius,
        touch: Option<Force>,
        landed_ticks: u32,
    ) {
        let at_rest = touch.is_none() && self.lifted_ticks >= RESTED_TICKS;
        self.before = Some(match self.before {
            None => Before { skin, room },
            Some(before) if !at_rest => before,
            Some(before) => Before {
                skin: filter(before.skin, skin),
                room: filter(before.room, room),
            },
        });
        match (touch, &mut self.grip) {
            (None, grip) => *grip = None,
            (Some(force), grip @ None) => {
                *grip = Some(Grip {
                    force: ForceMean::new(force),
                    change: Change::New,
                    steady: self.lifted_ticks >= RESTED_TICKS,
                    risen: force,
                    elapsed: landed_ticks.into(),
                    links: None,
                });
            }
            (Some(force), Some(grip)) => {
                grip.change = grip.force.update(force);
                grip.elapsed += 1;
                if grip.elapsed < MEAN_TICKS {
                    grip.risen = grip.force.mean();
                }
                let drifted = grip.force.mean().abs_diff(grip.risen) > grip.risen >> CONSTANT_SHIFT;
                let changed = grip.change == Change::New && grip.elapsed >= SETTLED_TICKS;
                grip.steady &= !drifted && !changed;
            }
        }
        self.lifted_ticks = match touch {
            Some(_) => 0,
            None => self.lifted_ticks.saturating_add(1),
        };
    }

    /// Forgets skin and contact: they were not watched.
    pub fn lose_sight(&mut self) {
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

    /// Wanted display temperature while no object is presented: that of the skin before contact. `None`
    /// until it was observed.
    #[must_use]
    pub fn neutral(&self) -> Option<Celsius> {
        self.before.map(|before| before.skin)
    }

    /// A contact that begins with the next [`Self::present`] is a new one, with whatever pair.
    pub fn forget_contact(&mut self) {
        self.touching = None;
        self.skin.forget_object();
        if let Some(grip) = &mut self.grip {
            grip.links = None;
        }
    }

    /// Heat into a display, W, whose surface is `display`; `pair` is that of the scene, or any with that display if
    /// nothing is presented.
    pub fn load(&mut self, pair: &ContactPair, display: Celsius) -> Watt {
        let Some(before) = self.before else {
            return Watt::ZERO;
        };
        let Some(grip) = &mut self.grip else {
            self.skin.touch_display(None, before.skin, display);
            return Watt::ZERO;
        };
        let force = grip.force.mean();
        if !grip.links.as_ref().is_some_and(|links| links.do_for(force)) {
            grip.links = Some(Links::new(pair, force));
        }
        let drive = self
            .skin
            .touch_display(grip.links.as_ref(), before.skin, display);
        // mm2 in 2^-16 and K in 2^-22 to W in 2^-24.
        let area = i64::from(contact_area(force).to_bits());
        let per_mm2 = (i64::from(drive.to_bits()) * i64::from(FLUX_W_MM2K)) >> 30;
        Watt::from_bits(((per_mm2 * area) >> 14).clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }

    /// Wanted display temperature of this tick while `scene` is presented. `None` until the skin was observed.
    ///
    /// `live`: the skin is followed as it is on the display, whose surface is at `display`; otherwise Eq. 6-12 holds
    /// in closed form, as if every contact were the first and its force had always been what it is.
    pub fn present(&mut self, scene: &Scene<'_>, display: Celsius, live: bool) -> Option<Wanted> {
        let Before { skin, room } = self.before?;
        let object = scene.object.unwrap_or(room);
        let only = |setpoint| {
            Some(Wanted {
                setpoint,
                target: setpoint,
            })
        };
        if scene.mode == Mode::SemiInfinite {
            self.touching = None;
            return only(scene.pair.interface_temperature(skin, object));
        }
        let apart = skin.saturating_sub(object);
        if !self.bodies.are_of(scene.pair) {
            self.bodies = Bodies::new(scene.pair);
        }
        let bodies = &self.bodies;
        let Some(grip) = &mut self.grip else {
            self.touching = None;
            self.skin.touch_object(None, bodies, apart);
            if !live {
                return only(scene.pair.preset(skin, object));
            }
            let setpoint = self.skin.display(bodies, skin, apart, false);
            return Some(Wanted {
                setpoint,
                target: setpoint.saturating_sub(landing(skin, setpoint)),
            });
        };
        let fresh = self.touching.is_none();
        let touching = self.touching.get_or_insert_with(|| {
            // A finger that rests there when the object appears touches it now.
            let elapsed = if grip.change == Change::New {
                grip.elapsed
            } else {
                0
            };
            Touching {
                elapsed,
                same: Force::ZERO..=Force::ZERO,
                course: None,
                due: false,
            }
        });
        if fresh {
            let preset = scene.pair.preset(skin, object);
            // Half way between where it should be and where it waits for the finger.
            let half = landing(skin, preset) >> 1u32;
            let off = display.saturating_sub(preset).saturating_add(half).abs();
            grip.steady &= off <= LATE.saturating_add(half.abs());
        } else {
            touching.elapsed += 1;
        }
        self.skin.touch_object(grip.links.as_ref(), bodies, apart);
        let closed = grip.steady || !live;
        let new = grip.change == Change::New;
        let same = !grip.force.is_better() || touching.same.contains(&grip.force.mean());
        if !closed || (new && live) {
            touching.course = None;
        }
        let due = touching.due && closed && !new;
        touching.due =
            closed && (grip.change != Change::Noise || !same || due || touching.course.is_none());
        let known = due && grip.contact_in_use().is_some();
        if touching.due && !known {
            grip.use_mean(scene.pair);
        }
        // While the skin is followed, not both in one tick.
        let setpoint = match (grip.contact_in_use(), &mut touching.course) {
            (Some(contact), course) if touching.due && (known || !live) => {
                let (laid, evaluations) =
                    ChordInterpolation::new(contact, skin, object, touching.elapsed, TOLERANCE);
                self.evaluations = self.evaluations.wrapping_add(evaluations);
                touching.same = all_the_same(grip.force.in_use(), laid.transient_amplitude());
                touching.due = false;
                course.insert(laid).setpoint()
            }
            (_, Some(course)) => {
                let setpoint = course.advance();
                self.evaluations = self
                    .evaluations
                    .wrapping_add(course.has_just_evaluated().into());
                setpoint
            }
            (_, None) => self.skin.display(bodies, skin, apart, true),
        };
        let correction = match (&grip.links, live) {
            (Some(links), true) => self.skin.correction(links),
            _ => Celsius::ZERO,
        };
        let target = setpoint.saturating_add(correction);
        let setpoint = if closed { setpoint } else { target };
        Some(Wanted { setpoint, target })
    }
}

#[cfg(test)]
mod tests;

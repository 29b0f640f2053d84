//! Scene to set-point: what the display should feel like, now.
//!
//! Before contact the display is preset to Eq. 6-12 at `t = 0`, from the skin's and the object's
//! temperatures; from landing on it follows Eq. 6-12; when the finger lifts it is preset again. In the
//! semi-infinite mode (chapter 4 of the thesis) it holds the interface temperature of Eq. 3-1 throughout.

mod force_mean;

use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, Course, Force, Pairing, log2_relative_pressure};

use force_mean::{Change, ForceMean, all_the_same};

/// How far the set-point may be from Eq. 6-12 at the force for which contact resistance was computed. What
/// is left to noise of the force makes this 0.5 mK.
pub const TOLERANCE: Celsius = Celsius::lit("0.0004");

/// Time constant of the filters before contact, as a power of two of ticks (0.26 s).
const FILTER_SHIFT: u32 = 8;

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
pub struct Scene {
    /// The material.
    pub pairing: Pairing,
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

/// A contact that lasts.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Touching {
    /// Ticks since landing.
    elapsed: u64,
    force: ForceMean,
    /// Forces for which contact resistance need not be computed again.
    same: RangeInclusive<Force>,
    course: Course,
}

/// Follows skin and contact; gives the wanted display temperature.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Render {
    /// Skin and room before contact, filtered.
    before: Option<Before>,
    touching: Option<Touching>,
    evaluations: u32,
}

impl Render {
    /// Follows skin and room; before contact only: the skin's sensor sees little of it during contact, and
    /// Eq. 6-12 starts from the temperatures before it.
    pub fn observe(&mut self, skin: Celsius, room: Celsius, touching: bool) {
        self.before = Some(match self.before {
            None => Before { skin, room },
            Some(before) if touching => before,
            Some(before) => Before {
                skin: filter(before.skin, skin),
                room: filter(before.room, room),
            },
        });
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

    /// A contact that begins with the next [`Self::present`] is a new one.
    pub fn forget_contact(&mut self) {
        self.touching = None;
    }

    /// Wanted display temperature of this tick while `scene` is presented.
    ///
    /// `touch` is the force, if a finger touches; `landed_ticks` is how long ago it landed if it was noticed
    /// in this tick. `None` until the skin was observed.
    pub fn present(&mut self, scene: &Scene, touch: Option<Force>, landed_ticks: u32) -> Option<Celsius> {
        let Before { skin, room } = self.before?;
        let object = scene.object.unwrap_or(room);
        if scene.mode == Mode::SemiInfinite {
            self.touching = None;
            return Some(scene.pairing.interface_temperature(skin, object));
        }
        let Some(force) = touch else {
            self.touching = None;
            return Some(scene.pairing.preset(skin, object));
        };
        let lay = |force, elapsed| {
            let contact = scene.pairing.under(log2_relative_pressure(force));
            let (course, evaluations) = Course::new(&contact, skin, object, elapsed, TOLERANCE);
            (course, all_the_same(force, course.gain()), evaluations)
        };
        let (setpoint, evaluations) = match &mut self.touching {
            None => {
                let elapsed = landed_ticks.into();
                let (course, same, evaluations) = lay(force, elapsed);
                self.touching = Some(Touching {
                    elapsed,
                    force: ForceMean::new(force),
                    same,
                    course,
                });
                (course.setpoint(), evaluations)
            }
            Some(touching) => {
                touching.elapsed += 1;
                let change = touching.force.update(force);
                let same = || !touching.force.is_better() || touching.same.contains(&touching.force.mean());
                if change == Change::Noise && same() {
                    let setpoint = touching.course.advance();
                    (setpoint, touching.course.is_at_knot().into())
                } else {
                    let (course, same, evaluations) = lay(touching.force.take(), touching.elapsed);
                    (touching.course, touching.same) = (course, same);
                    (course.setpoint(), evaluations)
                }
            }
        };
        self.evaluations = self.evaluations.wrapping_add(evaluations);
        Some(setpoint)
    }
}

#[cfg(test)]
mod tests;

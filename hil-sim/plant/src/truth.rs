//! A finger on an object, without a display: what the plant's truth is made of, by itself.

use super::bridge::{Bridge, BridgeParams, Legs};
use super::finger::FingerParams;
use super::heat::{Finger, Heat};
use super::object::ObjectConfig;
use super::slab::{Grading, Probe, Slab};
use super::tile::{Tile, TileParams};
use super::touch::Touch;
use super::{RECEPTORS_M, STEP_S, schedule};

/// The thesis's finger that lands on an object at time zero.
#[derive(Clone, Debug)]
pub struct Truth {
    heat: Heat,
    receptors: [Option<Probe>; RECEPTORS_M.len()],
    idle: Bridge,
    /// Sub-steps that are left of this step.
    left: Vec<usize>,
    /// Steps begun.
    age: u32,
    step_s: f64,
    time_s: f64,
}

impl Truth {
    /// A homogeneous finger of one temperature, deg C, in contact from now on, on the mesh and in the steps of every
    /// run; right for `duration_s`.
    #[must_use]
    pub fn new(skin_c: f64, object: &ObjectConfig, touch: Touch, duration_s: f64) -> Self {
        Self::cut(skin_c, object, touch, duration_s, (&Grading::RUN, STEP_S))
    }

    /// The same on another mesh or in steps of another length, s.
    #[must_use]
    pub fn cut(
        skin_c: f64,
        object: &ObjectConfig,
        touch: Touch,
        duration_s: f64,
        (grading, step_s): (&Grading, f64),
    ) -> Self {
        let finger = FingerParams::homogeneous();
        let cut = |layers: &[_], back| Slab::new(layers, back, duration_s, grading);
        let skin = cut(&finger.layers, finger.back());
        let mut heat = Heat::new(
            (&skin, skin_c),
            (&cut(&[object.layer()], object.back), object.start_c),
            Tile::new(TileParams::CLASS, skin_c),
            (finger.air_w_m2k, skin_c),
            step_s,
        );
        heat.touch(None, Some(touch), true);
        Self {
            heat,
            receptors: RECEPTORS_M.map(|depth_m| Probe::at(&skin, depth_m)),
            idle: Bridge::new(BridgeParams::NOMINAL, TileParams::CLASS.resistance_ohm()),
            left: Vec::new(),
            age: 0,
            step_s,
            time_s: 0.0,
        }
    }

    /// Advances by one sub-step: short right after landing, a whole step later.
    pub fn sub_step(&mut self) {
        if self.left.is_empty() {
            self.left.extend(schedule::sub_steps(self.age));
            self.left.reverse();
            self.age = self.age.saturating_add(1);
        }
        if let Some(index) = self.left.pop() {
            self.heat.step(index, &mut self.idle, &Legs::default());
            self.time_s += schedule::length_s(self.step_s, index);
        }
    }

    /// Time since landing, s.
    #[must_use]
    pub const fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Surface of the skin, deg C.
    #[must_use]
    pub fn skin_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnObject)
    }

    /// The skin at the depth of its receptors of cold and of warmth ([`RECEPTORS_M`]), deg C.
    #[must_use]
    pub fn receptors_c(&self) -> [Option<f64>; RECEPTORS_M.len()] {
        let read =
            |probe: Option<Probe>| probe.map(|probe| self.heat.depth_c(Finger::OnObject, &probe));
        self.receptors.map(read)
    }

    /// Surface of the object, deg C.
    #[must_use]
    pub fn object_c(&self) -> f64 {
        self.heat.object_c()
    }

    /// Heat flux out of the skin, W/m2.
    #[must_use]
    pub fn flux_w_m2(&self) -> f64 {
        self.heat.flux_w_m2(Finger::OnObject)
    }
}

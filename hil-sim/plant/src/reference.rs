//! Reference solution: a finger on the real object, without display and electronics.

use super::bridge::{Bridge, BridgeOutputs, BridgeParams};
use super::contact::SkinContact;
use super::finger::FingerParams;
use super::object::ObjectConfig;
use super::slab::{DepthProbe, Grading, Slab};
use super::thermal::{Finger, ThermalModel};
use super::tile::{Tile, TileParams};
use super::{RECEPTORS_M, STEP_S, substeps};

/// The thesis's finger on an object from time zero on.
#[derive(Clone, Debug)]
pub struct ReferenceSolution {
    heat: ThermalModel,
    receptors: [Option<DepthProbe>; RECEPTORS_M.len()],
    idle_bridge: Bridge,
    /// Remaining sub-steps of this step, the next one last.
    remaining: Vec<usize>,
    /// Number of steps begun.
    age: u32,
    step_s: f64,
    time_s: f64,
}

impl ReferenceSolution {
    /// A homogeneous finger of uniform temperature, deg C, in contact from now on, with the mesh and the steps of every
    /// simulation; half-spaces are deep enough for `duration_s`.
    pub fn new(skin_c: f64, object: &ObjectConfig, touch: SkinContact, duration_s: f64) -> Self {
        Self::on_mesh(skin_c, object, touch, duration_s, (&Grading::STANDARD, STEP_S))
    }

    /// The same with another mesh or step length, s.
    pub fn on_mesh(
        skin_c: f64,
        object: &ObjectConfig,
        touch: SkinContact,
        duration_s: f64,
        (grading, step_s): (&Grading, f64),
    ) -> Self {
        let finger = FingerParams::homogeneous();
        let mesh = |layers: &[_], back| Slab::new(layers, back, duration_s, grading);
        let skin = mesh(&finger.layers, finger.back());
        let mut heat = ThermalModel::new(
            (&skin, skin_c),
            (&mesh(&object.layers, object.back), object.start_c),
            Tile::new(TileParams::NOMINAL, skin_c),
            (finger.air_w_m2k, skin_c),
            step_s,
        );
        heat.set_contacts(None, Some(touch), true);
        Self {
            heat,
            receptors: RECEPTORS_M.map(|depth_m| DepthProbe::at(&skin, depth_m)),
            idle_bridge: Bridge::new(BridgeParams::NOMINAL, TileParams::NOMINAL.resistance_ohm()),
            remaining: Vec::new(),
            age: 0,
            step_s,
            time_s: 0.0,
        }
    }

    /// Advances by one sub-step: a fraction of a step soon after landing, a whole step later.
    pub fn sub_step(&mut self) {
        if self.remaining.is_empty() {
            self.remaining.extend(substeps::of_step(self.age));
            self.remaining.reverse();
            self.age = self.age.saturating_add(1);
        }
        if let Some(index) = self.remaining.pop() {
            self.heat.step(index, &mut self.idle_bridge, &BridgeOutputs::default());
            self.time_s += substeps::length_s(self.step_s, index);
        }
    }

    /// Time since landing, s.
    pub const fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Surface of the skin, deg C.
    pub fn skin_c(&self) -> f64 {
        self.heat.skin_c(Finger::OnObject)
    }

    /// Skin temperature at the depth of the cold and warm receptors ([`RECEPTORS_M`]), deg C.
    pub fn receptors_c(&self) -> [Option<f64>; RECEPTORS_M.len()] {
        let read = |probe: Option<DepthProbe>| {
            probe.map(|probe| self.heat.depth_c(Finger::OnObject, &probe))
        };
        self.receptors.map(read)
    }

    /// Surface of the object, deg C.
    pub fn object_c(&self) -> f64 {
        self.heat.object_c()
    }

    /// Heat flux out of the skin, W/m2.
    pub fn flux_w_m2(&self) -> f64 {
        self.heat.flux_w_m2(Finger::OnObject)
    }
}

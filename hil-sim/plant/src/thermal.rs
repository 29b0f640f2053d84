//! Thermal model of finger, display and real object, which are solved together in each step.
//!
//! ```text
//! [ finger ] - R - [ patch | tile | sink ]      on the display
//! [ finger ] - R - [ object ]                   reference: the same finger on the real object
//! ```
//!
//! Each slab is eliminated from its depth to its surface, then the tile from the contact to the sink: bodies in contact
//! are coupled implicitly, without a lag between them. The finger is modelled per square metre of contact and the tile as
//! a whole: where the contact area grows, tissue of the same temperature profile is added.

use super::bridge::{Bridge, BridgeOutputs};
use super::contact::SkinContact;
use super::energy::{Energy, EnergyBalance};
use super::slab::{DepthProbe, Slab, SlabBatch, SteadyState, SurfaceEquation};
use super::substeps;
use super::tile::{CoolingDefects, ModuleDefect, Tile};

/// The finger on the display, or the same finger on the real object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finger {
    /// On the display.
    OnDisplay,
    /// On the real object.
    OnObject,
}

/// Number of slabs: both fingers and the object.
const SLABS: usize = 3;
const OBJECT: usize = 2;

/// All bodies of one finger's plant.
#[derive(Clone, Debug)]
pub struct ThermalModel {
    slabs: SlabBatch<SLABS>,
    tile: Tile,
    room_c: f64,
    /// Resistance from each slab's surface to its first node, m2 K/W.
    surface_m2k_w: [f64; SLABS],
    /// Conductance from that node to the air at a surface without contact, W/(m2 K).
    lifted_w_m2k: [f64; SLABS],
    /// The same at present: zero where the surface is covered.
    air_w_m2k: [f64; SLABS],
    /// Conductances between the nodes next to each contact, W/(m2 K); zero without contact.
    on_display_w_m2k: f64,
    on_object_w_m2k: f64,
    area_m2: f64,
    /// Whether finger and object are as they started, so that their slabs need no steps: the finger in steady state and not
    /// yet touched, the object not yet there.
    at_rest: bool,
    step_s: f64,
    energy_balance: EnergyBalance,
}

impl ThermalModel {
    /// Finger and object at uniform temperatures, deg C, without contact, in a room with a film coefficient, W/(m2 K),
    /// and a temperature, deg C; for steps of `step_s` and their sub-steps.
    pub fn new(
        (finger, skin_c): (&Slab, f64),
        (object, object_c): (&Slab, f64),
        tile: Tile,
        (film_w_m2k, room_c): (f64, f64),
        step_s: f64,
    ) -> Self {
        let slabs = [finger, finger, object];
        let lengths_s: [f64; substeps::LENGTHS] =
            std::array::from_fn(|k| substeps::length_s(step_s, k));
        let lifted_w_m2k = slabs.map(|s| 1.0 / (s.surface_m2k_w + 1.0 / film_w_m2k));
        Self {
            slabs: SlabBatch::new(slabs, [skin_c, skin_c, object_c], &lengths_s),
            tile,
            room_c,
            surface_m2k_w: slabs.map(|s| s.surface_m2k_w),
            lifted_w_m2k,
            air_w_m2k: lifted_w_m2k,
            on_display_w_m2k: 0.0,
            on_object_w_m2k: 0.0,
            area_m2: 0.0,
            at_rest: false,
            step_s,
            energy_balance: EnergyBalance::default(),
        }
    }

    /// Sets the finger to its steady state in the air of the room, where it stays until the first contact.
    pub fn set_finger_at_rest(&mut self, steady: &SteadyState) {
        self.set_finger(&steady.node_c, steady.core_c);
        self.at_rest = true;
    }

    /// Sets the temperatures of the finger's nodes and of its core, deg C.
    fn set_finger(&mut self, node_c: &[f64], core_c: f64) {
        for slab in [Finger::OnDisplay as usize, Finger::OnObject as usize] {
            for (node, temperature_c) in node_c.iter().enumerate() {
                self.slabs.set_node_c(slab, node, *temperature_c);
            }
            self.slabs.set_core_c(slab, core_c);
        }
    }

    /// Sets the object to a uniform temperature, deg C.
    pub fn set_object(&mut self, temperature_c: f64) {
        for node in 0..self.slabs.cells() {
            self.slabs.set_node_c(OBJECT, node, temperature_c);
        }
    }

    /// Sets the blood flow of the finger as a fraction of its full flow.
    pub fn set_flow(&mut self, share: f64) {
        self.slabs.set_flow(Finger::OnDisplay as usize, share);
        self.slabs.set_flow(Finger::OnObject as usize, share);
    }

    /// Sets the defects of the sink's cooling.
    pub fn set_cooling(&mut self, defects: &CoolingDefects) {
        self.tile.set_cooling(defects);
    }

    /// Sets the defect of the thermoelectric module.
    pub const fn set_module(&mut self, defect: ModuleDefect) {
        self.tile.set_defect(defect);
    }

    /// Sets both contacts. The object exchanges heat with the air only while it is present.
    pub fn set_contacts(
        &mut self,
        on_display: Option<SkinContact>,
        on_object: Option<SkinContact>,
        object_present: bool,
    ) {
        self.at_rest &= on_display.is_none() && on_object.is_none() && !object_present;
        let [finger, _, object] = self.surface_m2k_w;
        let plate_k_w = self.tile.patch_half_k_w();
        self.on_display_w_m2k =
            on_display.map_or(0.0, |t| 1.0 / (finger + t.resistance_m2k_w + plate_k_w * t.area_m2));
        self.on_object_w_m2k =
            on_object.map_or(0.0, |t| 1.0 / (finger + t.resistance_m2k_w + object));
        let area_m2 = on_display.map_or(0.0, |t| t.area_m2);
        if area_m2 != self.area_m2 {
            self.area_m2 = area_m2;
            self.tile.cover(area_m2);
        }
        let covered =
            [on_display.is_some(), on_object.is_some(), on_object.is_some() || !object_present];
        self.air_w_m2k =
            std::array::from_fn(|l| if covered[l] { 0.0 } else { self.lifted_w_m2k[l] });
    }

    /// Advances by the sub-step of the given index under constant bridge outputs.
    pub fn step(&mut self, index: usize, bridge: &mut Bridge, legs: &BridgeOutputs) {
        let step_s = substeps::length_s(self.step_s, index);
        self.tile.prepare(step_s);
        self.tile.drive(bridge.current(step_s, legs, &self.tile.load()));
        if self.at_rest {
            self.step_tile_alone(step_s);
        } else {
            self.step_all(index, step_s);
        }
    }

    /// Advances the tile, which no finger covers.
    fn step_tile_alone(&mut self, step_s: f64) {
        self.tile.first_stage(step_s, 0.0, 0.0, 0.0);
        self.tile.second_stage(0.0);
        self.energy_balance.add(&self.tile.step_energy(step_s));
    }

    /// Advances tile, finger and object by the sub-step of the given index and length.
    fn step_all(&mut self, index: usize, step_s: f64) {
        let out = self.outward_flux_w_m2();
        let inflow_w = self.area_m2 * self.flux_w_m2(Finger::OnDisplay);
        let equations = self.slabs.first_stage(index, out.map(|w_m2| -w_m2));
        let equations = self.with_air(equations);
        let (pivot, rhs) = self.patch_equation(&equations[0]);
        let patch_x = self.tile.first_stage(step_s, inflow_w, pivot, rhs);
        let x = self.surface_increments(&equations, patch_x);
        let equations = self.slabs.second_stage(index, x);
        let equations = self.with_air(equations);
        let (_, rhs) = self.patch_equation(&equations[0]);
        let patch_x = self.tile.second_stage(rhs);
        let x = self.surface_increments(&equations, patch_x);
        self.slabs.finish_step(index, x);

        let fall_c = self.slabs.mean_c(0, 0) - self.tile.mean_patch_c();
        self.energy_balance.add(&Energy {
            from_finger_j: step_s * self.area_m2 * self.on_display_w_m2k * fall_c,
            ..self.tile.step_energy(step_s)
        });
    }

    /// Heat flux out of every surface into its contact and into the air, W/m2.
    fn outward_flux_w_m2(&self) -> [f64; SLABS] {
        let on_object = self.flux_w_m2(Finger::OnObject);
        let contact = [self.flux_w_m2(Finger::OnDisplay), on_object, -on_object];
        std::array::from_fn(|l| {
            contact[l] + self.air_w_m2k[l] * (self.slabs.surface_c(l) - self.room_c)
        })
    }

    /// Adds the film conductance of the air to the pivots.
    fn with_air(&self, mut equations: [SurfaceEquation; SLABS]) -> [SurfaceEquation; SLABS] {
        for (equation, air) in equations.iter_mut().zip(self.air_w_m2k) {
            equation.pivot += air;
        }
        equations
    }

    /// Contribution of the eliminated finger to the equation of the patch: pivot, W/K, and right-hand side, W.
    fn patch_equation(&self, finger: &SurfaceEquation) -> (f64, f64) {
        let link_w_k = self.area_m2 * self.on_display_w_m2k;
        let part = link_w_k / (finger.pivot + self.on_display_w_m2k);
        (part * finger.pivot, part * finger.rhs)
    }

    /// Increments of the surface cells, given that of the patch.
    fn surface_increments(
        &self,
        equations: &[SurfaceEquation; SLABS],
        patch_x: f64,
    ) -> [f64; SLABS] {
        let [on_display, finger, object] = equations;
        let u = self.on_display_w_m2k;
        let v = self.on_object_w_m2k;
        // Cramer's rule; all terms are positive, so nothing cancels.
        let determinant = finger.pivot * object.pivot + v * (finger.pivot + object.pivot);
        let shared = v * (finger.rhs + object.rhs);
        [
            (on_display.rhs + u * patch_x) / (on_display.pivot + u),
            (finger.rhs * object.pivot + shared) / determinant,
            (object.rhs * finger.pivot + shared) / determinant,
        ]
    }

    /// Heat flux out of the skin into its contact, W/m2.
    pub fn flux_w_m2(&self, finger: Finger) -> f64 {
        let skin_c = self.slabs.surface_c(finger as usize);
        match finger {
            Finger::OnDisplay => self.on_display_w_m2k * (skin_c - self.tile.patch_c()),
            Finger::OnObject => self.on_object_w_m2k * (skin_c - self.slabs.surface_c(OBJECT)),
        }
    }

    fn surface_c(&self, slab: usize) -> f64 {
        self.slabs.surface_c(slab) - self.outward_flux_w_m2()[slab] * self.surface_m2k_w[slab]
    }

    /// Temperature of the skin surface, deg C.
    pub fn skin_c(&self, finger: Finger) -> f64 {
        self.surface_c(finger as usize)
    }

    /// Temperature of the skin at the depth of a probe, deg C.
    pub fn depth_c(&self, finger: Finger, probe: &DepthProbe) -> f64 {
        probe.read(|node| self.slabs.node_c(finger as usize, node))
    }

    /// Surface temperature of the real object, deg C.
    pub fn object_c(&self) -> f64 {
        self.surface_c(OBJECT)
    }

    /// Surface temperature of the display under the finger, deg C.
    pub fn display_c(&self) -> f64 {
        let power_w = self.area_m2 * self.flux_w_m2(Finger::OnDisplay);
        self.tile.patch_c() + power_w * self.tile.patch_half_k_w()
    }

    /// The tile with its sink.
    pub const fn tile(&self) -> &Tile {
        &self.tile
    }

    /// Energy that has crossed the boundaries of the tile.
    pub fn energy(&self) -> Energy {
        self.energy_balance.total()
    }
}

#[cfg(test)]
mod tests;

//! Finger, display and real object, and the heat between them: one step of all.
//!
//! ```text
//! [ finger ] - R - [ patch | tile | sink ]      on the display
//! [ finger ] - R - [ object ]                   the truth: the same finger on the real thing
//! ```
//!
//! Slabs are eliminated from their depth, the tile from the finger: what touches is solved at once, with no lag
//! between the bodies. The finger counts per square metre of contact, the tile whole: when the contact grows, tissue
//! of the same temperatures joins.

use super::bridge::{Bridge, Legs};
use super::ledger::{Energy, Ledger};
use super::schedule;
use super::slab::{Lanes, Probe, Row, Slab};
use super::tile::{CoolingDefects, ModuleDefect, Tile};
use super::touch::Touch;

/// A finger: on the display, or the same one on the real object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finger {
    /// On the display.
    OnDisplay,
    /// On the real object.
    OnObject,
}

/// Lanes of the slabs: both fingers and the object.
const LANES: usize = 3;
const OBJECT: usize = 2;

/// All bodies of one finger.
#[derive(Clone, Debug)]
pub struct Heat {
    slabs: Lanes<LANES>,
    tile: Tile,
    room_c: f64,
    /// From each slab's surface to its first node, m2 K/W.
    surface_m2k_w: [f64; LANES],
    /// From that node to the air when nothing touches the surface, W/(m2 K).
    lifted_w_m2k: [f64; LANES],
    /// The same now.
    air_w_m2k: [f64; LANES],
    /// Between the nodes next to each contact, W/(m2 K); zero when apart.
    on_display_w_m2k: f64,
    on_object_w_m2k: f64,
    area_m2: f64,
    step_s: f64,
    ledger: Ledger,
}

impl Heat {
    /// Finger and object at one temperature each, deg C, the tile at that of the room, all apart, with a film of air on
    /// lifted surfaces, W/(m2 K); for steps of `step_s` and their sub-steps.
    #[must_use]
    pub fn new(
        (finger, skin_c): (&Slab, f64),
        (object, object_c): (&Slab, f64),
        tile: Tile,
        (film_w_m2k, room_c): (f64, f64),
        step_s: f64,
    ) -> Self {
        let slabs = [finger, finger, object];
        let lengths_s: [f64; schedule::LENGTHS] =
            std::array::from_fn(|k| schedule::length_s(step_s, k));
        let lifted_w_m2k = slabs.map(|s| 1.0 / (s.surface_m2k_w + 1.0 / film_w_m2k));
        Self {
            slabs: Lanes::new(slabs, [skin_c, skin_c, object_c], &lengths_s),
            tile,
            room_c,
            surface_m2k_w: slabs.map(|s| s.surface_m2k_w),
            lifted_w_m2k,
            air_w_m2k: lifted_w_m2k,
            on_display_w_m2k: 0.0,
            on_object_w_m2k: 0.0,
            area_m2: 0.0,
            step_s,
            ledger: Ledger::default(),
        }
    }

    /// Brings the finger to rest: its nodes, and the temperature of its core, deg C.
    pub fn rest_finger(&mut self, node_c: &[f64], core_c: f64) {
        for lane in [Finger::OnDisplay as usize, Finger::OnObject as usize] {
            for (node, temperature_c) in node_c.iter().enumerate() {
                self.slabs.set_node_c(lane, node, *temperature_c);
            }
            self.slabs.set_core_c(lane, core_c);
        }
    }

    /// Brings the object to one temperature, deg C.
    pub fn place_object(&mut self, temperature_c: f64) {
        for node in 0..self.slabs.cells() {
            self.slabs.set_node_c(OBJECT, node, temperature_c);
        }
    }

    /// Share of its full flow that the finger's blood has.
    pub fn set_flow(&mut self, share: f64) {
        self.slabs.set_flow(Finger::OnDisplay as usize, share);
        self.slabs.set_flow(Finger::OnObject as usize, share);
    }

    /// Cools the tile's sink as well as its defects allow.
    pub fn cool(&mut self, defects: &CoolingDefects) {
        self.tile.cool(defects);
    }

    /// Breaks the tile's module, or mends it.
    pub const fn set_module(&mut self, defect: ModuleDefect) {
        self.tile.set_defect(defect);
    }

    /// Closes, changes or opens the contacts. Air cools the object only while it is there.
    pub fn touch(
        &mut self,
        on_display: Option<Touch>,
        on_object: Option<Touch>,
        object_is_there: bool,
    ) {
        let [finger, _, object] = self.surface_m2k_w;
        let plate_k_w = self.tile.patch_half_k_w();
        self.on_display_w_m2k = on_display.map_or(0.0, |t| {
            1.0 / (finger + t.resistance_m2k_w + plate_k_w * t.area_m2)
        });
        self.on_object_w_m2k =
            on_object.map_or(0.0, |t| 1.0 / (finger + t.resistance_m2k_w + object));
        let area_m2 = on_display.map_or(0.0, |t| t.area_m2);
        if area_m2 != self.area_m2 {
            self.area_m2 = area_m2;
            self.tile.cover(area_m2);
        }
        let covered = [
            on_display.is_some(),
            on_object.is_some(),
            on_object.is_some() || !object_is_there,
        ];
        self.air_w_m2k = std::array::from_fn(|l| {
            if covered[l] {
                0.0
            } else {
                self.lifted_w_m2k[l]
            }
        });
    }

    /// Advances by the sub-step of the given index with the bridge's legs held.
    pub fn step(&mut self, index: usize, bridge: &mut Bridge, legs: &Legs) {
        let step_s = schedule::length_s(self.step_s, index);
        self.tile.prepare(step_s);
        self.tile
            .drive(bridge.current(step_s, legs, &self.tile.load()));

        let out = self.out_w_m2();
        let inflow_w = self.area_m2 * self.flux_w_m2(Finger::OnDisplay);
        let rows = self.slabs.first(index, out.map(|w_m2| -w_m2));
        let rows = self.open(rows);
        let (pivot, rhs) = self.patch_row(&rows[0]);
        let patch_x = self.tile.first(step_s, inflow_w, pivot, rhs);
        let x = self.close(&rows, patch_x);
        let rows = self.slabs.second(index, x);
        let rows = self.open(rows);
        let (_, rhs) = self.patch_row(&rows[0]);
        let patch_x = self.tile.second(rhs);
        let x = self.close(&rows, patch_x);
        self.slabs.finish(index, x);

        let fall_c = self.slabs.mean_c(0, 0) - self.tile.mean_patch_c();
        self.ledger.add(&Energy {
            from_finger_j: step_s * self.area_m2 * self.on_display_w_m2k * fall_c,
            ..self.tile.crossed(step_s)
        });
    }

    /// Flux out of every surface, W/m2: into what it touches and into the air.
    fn out_w_m2(&self) -> [f64; LANES] {
        let on_object = self.flux_w_m2(Finger::OnObject);
        let contact = [self.flux_w_m2(Finger::OnDisplay), on_object, -on_object];
        std::array::from_fn(|l| {
            contact[l] + self.air_w_m2k[l] * (self.slabs.surface_c(l) - self.room_c)
        })
    }

    /// Rows with what the air adds to them.
    fn open(&self, mut rows: [Row; LANES]) -> [Row; LANES] {
        for (row, air) in rows.iter_mut().zip(self.air_w_m2k) {
            row.pivot += air;
        }
        rows
    }

    /// What the eliminated finger leaves in the row of the patch: pivot, W/K, and right-hand side, W.
    fn patch_row(&self, finger: &Row) -> (f64, f64) {
        let link_w_k = self.area_m2 * self.on_display_w_m2k;
        let part = link_w_k / (finger.pivot + self.on_display_w_m2k);
        (part * finger.pivot, part * finger.rhs)
    }

    /// Increments of the surface cells, once that of the patch is known.
    fn close(&self, rows: &[Row; LANES], patch_x: f64) -> [f64; LANES] {
        let [on_display, finger, object] = rows;
        let u = self.on_display_w_m2k;
        let v = self.on_object_w_m2k;
        // Cramer's rule: sums of positive terms.
        let determinant = finger.pivot * object.pivot + v * (finger.pivot + object.pivot);
        let shared = v * (finger.rhs + object.rhs);
        [
            (on_display.rhs + u * patch_x) / (on_display.pivot + u),
            (finger.rhs * object.pivot + shared) / determinant,
            (object.rhs * finger.pivot + shared) / determinant,
        ]
    }

    /// Heat flux out of the skin into what it touches, W/m2.
    #[must_use]
    pub fn flux_w_m2(&self, finger: Finger) -> f64 {
        let skin_c = self.slabs.surface_c(finger as usize);
        match finger {
            Finger::OnDisplay => self.on_display_w_m2k * (skin_c - self.tile.patch_c()),
            Finger::OnObject => self.on_object_w_m2k * (skin_c - self.slabs.surface_c(OBJECT)),
        }
    }

    fn surface_c(&self, lane: usize) -> f64 {
        self.slabs.surface_c(lane) - self.out_w_m2()[lane] * self.surface_m2k_w[lane]
    }

    /// Surface of the skin, deg C.
    #[must_use]
    pub fn skin_c(&self, finger: Finger) -> f64 {
        self.surface_c(finger as usize)
    }

    /// The skin where a probe is, deg C.
    #[must_use]
    pub fn depth_c(&self, finger: Finger, probe: &Probe) -> f64 {
        probe.read(|node| self.slabs.node_c(finger as usize, node))
    }

    /// Surface of the real object, deg C.
    #[must_use]
    pub fn object_c(&self) -> f64 {
        self.surface_c(OBJECT)
    }

    /// Surface of the display under the finger, deg C.
    #[must_use]
    pub fn display_c(&self) -> f64 {
        let power_w = self.area_m2 * self.flux_w_m2(Finger::OnDisplay);
        self.tile.patch_c() + power_w * self.tile.patch_half_k_w()
    }

    /// The tile.
    #[must_use]
    pub const fn tile(&self) -> &Tile {
        &self.tile
    }

    /// What has crossed the tile's borders so far.
    #[must_use]
    pub fn energy(&self) -> Energy {
        self.ledger.total()
    }
}

#[cfg(test)]
mod tests;

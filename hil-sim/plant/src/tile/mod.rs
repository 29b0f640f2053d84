//! The thermoelectric tile between the display's surface and what cools its sink.
//!
//! ```text
//! plate (4 cells) - tab - legs (5 cells) - tab - plate (1 cell) - sink - coolant
//! ```
//!
//! in three zones across: the patch that the finger touches and two rings, joined by the plates. All legs carry one
//! current `I`. With the Seebeck coefficient `a(T)` between two nodes, a node of the legs takes up
//! `-I T (a_after - a_before)` (Thomson's heat) and a tab `-I a T` or `+I a T` (Peltier's); Joule's heat arises along
//! the legs. The sum of all is the electrical power. With constant properties and at rest this is
//! `Qc = a I Tc - I^2 R/2 - K (Th - Tc)` at the tabs.

mod cooling;
mod defect;
mod legs;
mod params;
mod stack;
mod zones;

pub use cooling::CoolingDefects;
pub use defect::ModuleDefect;
pub use params::{TileParams, ZERO_C_K};

use super::bridge::{Current, Load};
use super::ledger::Energy;
use super::slab::Cell;
use cooling::HEATER_W_K;
use legs::Legs;
use stack::Stack;
use zones::{ZONES, Zones};

/// Cells through the display plate, each twice as wide as the one nearer to the finger, and along the legs.
const PLATE_CELLS: usize = 4;
const PLATE_GROWTH: f64 = 2.0;
const LEG_CELLS: usize = 5;

const COLD_TAB: usize = PLATE_CELLS;
const HOT_TAB: usize = COLD_TAB + LEG_CELLS + 1;
const HOT_PLATE: usize = HOT_TAB + 1;
const LEVELS: usize = HOT_PLATE + 1;
/// Links of the legs: from the cold tab to the hot one.
const LINKS: usize = LEG_CELLS + 1;
/// The zone under the finger.
const PATCH: usize = 0;

/// The display plate cut into its cells, the surface first.
fn display_plate(params: &TileParams) -> [Cell; PLATE_CELLS] {
    let widths: [f64; PLATE_CELLS] = std::array::from_fn(|i| PLATE_GROWTH.powi(i as i32));
    let unit_m = params.ceramic_m / widths.iter().sum::<f64>();
    widths.map(|width| Cell::graded(unit_m * width, PLATE_GROWTH))
}

/// The tile of one finger.
#[derive(Clone, Debug)]
pub struct Tile {
    params: TileParams,
    zones: Zones,
    legs: Legs,
    stack: Stack<LEVELS, ZONES>,
    room_c: f64,
    defect: ModuleDefect,
    current: Current,
    /// From the display's surface to the first node, m.
    surface_m: f64,
    /// Share of each zone in the legs.
    share: [f64; ZONES],
    /// Seebeck coefficient at every link of the legs, V/K, and resistance of all legs, ohm: in the middle of the step.
    seebeck_v_k: [[f64; ZONES]; LINKS],
    resistance_ohm: f64,
    seebeck_v: f64,
    joule_w_a2: [[f64; ZONES]; LEG_CELLS],
}

impl Tile {
    /// The tile without current, all of it at the temperature of what cools its sink, in a room, deg C.
    #[must_use]
    pub fn new(params: TileParams, room_c: f64) -> Self {
        let zones = Zones::new(&params);
        let share = zones.area_m2.map(|m2| m2 / params.plate_m2());
        let mut stack = Stack::new(room_c + params.coolant_k);
        let plate = display_plate(&params);
        for (z, m2) in zones.area_m2.into_iter().enumerate() {
            let sheet_w = params.ceramic_w_mk * m2;
            // Display plate, the surface first; its last cell goes to the tab.
            for (level, cell) in plate.iter().enumerate() {
                let next_m = plate.get(level + 1).map_or(0.0, |next| next.node_m);
                stack.capacity[level][z] = params.ceramic_j_m3k * m2 * cell.width_m;
                stack.axial[level][z] = sheet_w / (cell.width_m - cell.node_m + next_m);
                stack.lateral[level][z] = params.ceramic_w_mk * cell.width_m * zones.shape[z];
            }
            for level in COLD_TAB..=HOT_TAB {
                stack.capacity[level][z] = match level {
                    COLD_TAB | HOT_TAB => params.tabs_j_k * share[z],
                    _ => params.legs_j_k * share[z] / LEG_CELLS as f64,
                };
            }
            // The hot plate is one cell.
            let half_k_w = 0.5 * params.ceramic_m / sheet_w;
            stack.axial[HOT_TAB][z] = 1.0 / half_k_w;
            stack.capacity[HOT_PLATE][z] = params.ceramic_j_m3k * m2 * params.ceramic_m;
            stack.lateral[HOT_PLATE][z] = params.ceramic_w_mk * params.ceramic_m * zones.shape[z];
            stack.axial[HOT_PLATE][z] = 1.0 / (half_k_w + 1.0 / (params.paste_w_k * share[z]));
        }
        stack.sink.capacity = params.sink_j_k;
        let mut tile = Self {
            params,
            zones,
            legs: Legs::new(params.sheet_hot_c, params.variation),
            stack,
            room_c,
            defect: ModuleDefect::NONE,
            current: Current::default(),
            surface_m: plate[0].node_m,
            share,
            seebeck_v_k: [[0.0; ZONES]; LINKS],
            resistance_ohm: 0.0,
            seebeck_v: 0.0,
            joule_w_a2: [[0.0; ZONES]; LEG_CELLS],
        };
        tile.cover(0.0);
        tile.cool(&CoolingDefects::NONE);
        tile
    }

    /// Cools the sink as well as its defects allow.
    pub fn cool(&mut self, defects: &CoolingDefects) {
        let coolant_c = defects
            .coolant_c
            .unwrap_or(self.room_c + self.params.coolant_k);
        let (to_c, k_w) = match defects.held_c {
            Some(held_c) => (held_c, HEATER_W_K.recip()),
            None => (coolant_c, self.params.sink_k_w * defects.resistance),
        };
        self.stack.sink.source = to_c / k_w;
        self.stack.sink.feedback = -1.0 / k_w;
    }

    /// Breaks the module, or mends it.
    pub const fn set_defect(&mut self, defect: ModuleDefect) {
        self.defect = defect;
    }

    /// Lets a finger cover a part of the patch, m2; air films the rest of the plate.
    pub fn cover(&mut self, area_m2: f64) {
        for (z, m2) in self.zones.area_m2.into_iter().enumerate() {
            let free_m2 = if z == PATCH {
                (m2 - area_m2).max(0.0)
            } else {
                m2
            };
            let film_w_k = self.params.film_w_m2k * free_m2;
            self.stack.source[0][z] = film_w_k * self.room_c;
            self.stack.feedback[0][z] = -film_w_k;
        }
    }

    /// Brings the legs' properties to the middle of a coming step, s.
    pub fn prepare(&mut self, step_s: f64) {
        let (all_ohm, all_w_k, all_v_k) = (
            self.params.resistance_ohm() / LEG_CELLS as f64,
            self.params.conductance_w_k() * LEG_CELLS as f64,
            self.params.seebeck_v_k() * self.defect.seebeck,
        );
        (self.resistance_ohm, self.seebeck_v) = (0.0, 0.0);
        for z in 0..ZONES {
            let share = self.share[z];
            let mut here_c = self.stack.ahead_c(COLD_TAB, z, step_s);
            for link in 0..LINKS {
                let next_c = self.stack.ahead_c(COLD_TAB + link + 1, z, step_s);
                let between_c = 0.5 * (here_c + next_c);
                let half_cell = if link == 0 || link + 1 == LINKS {
                    2.0
                } else {
                    1.0
                };
                self.stack.axial[COLD_TAB + link][z] =
                    share * all_w_k * half_cell * self.legs.conductivity(between_c);
                let seebeck_v_k = share * all_v_k * self.legs.seebeck(between_c);
                self.seebeck_v_k[link][z] = seebeck_v_k;
                self.seebeck_v += seebeck_v_k * (next_c - here_c);
                if link < LEG_CELLS {
                    let ohm = share * all_ohm * self.legs.resistivity(next_c);
                    self.joule_w_a2[link][z] = ohm;
                    self.resistance_ohm += ohm;
                }
                here_c = next_c;
            }
        }
    }

    /// What the bridge sees of the tile, as [prepared](Self::prepare); the Seebeck voltage opposes a cooling current.
    #[must_use]
    pub const fn load(&self) -> Load {
        Load {
            seebeck_v: self.seebeck_v,
            resistance_ohm: self.resistance_ohm,
        }
    }

    /// Lets a current flow in the coming step; positive cools the display.
    pub fn drive(&mut self, current: Current) {
        self.current = current;
        let mean_square_a2 = current.mean_a * current.mean_a + current.ripple_a2;
        for z in 0..ZONES {
            let mut before_w_k = 0.0;
            for node in 0..=LINKS {
                let after_w_k = match self.seebeck_v_k.get(node) {
                    Some(seebeck) => current.mean_a * seebeck[z],
                    None => 0.0,
                };
                let joule_w = match node.checked_sub(1).and_then(|leg| self.joule_w_a2.get(leg)) {
                    Some(ohm) => mean_square_a2 * ohm[z],
                    None => 0.0,
                };
                let feedback_w_k = before_w_k - after_w_k;
                self.stack.feedback[COLD_TAB + node][z] = feedback_w_k;
                self.stack.source[COLD_TAB + node][z] = joule_w + feedback_w_k * ZERO_C_K;
                before_w_k = after_w_k;
            }
        }
    }

    /// First stage of a step, s, with a power into the node under the finger, W, and what a body eliminated before
    /// the tile leaves in that node's row: pivot, W/K, and right-hand side, W. Gives that node's increment.
    pub fn first(&mut self, step_s: f64, inflow_w: f64, pivot_w_k: f64, rhs_w: f64) -> f64 {
        self.stack.first(step_s, inflow_w, pivot_w_k, rhs_w)
    }

    /// Second stage, likewise; ends the step.
    pub fn second(&mut self, rhs_w: f64) -> f64 {
        self.stack.second(rhs_w)
    }

    /// What crossed the tile's borders in the last step, s, but for the finger's heat.
    #[must_use]
    pub fn crossed(&self, step_s: f64) -> Energy {
        let mut seebeck_v = 0.0;
        for (link, across) in self.seebeck_v_k.iter().enumerate() {
            for (z, seebeck) in across.iter().enumerate() {
                let [here_c, next_c] = [0, 1].map(|i| self.stack.mean_c(COLD_TAB + link + i, z));
                seebeck_v += seebeck * (next_c - here_c);
            }
        }
        let mean_a = self.current.mean_a;
        let joule_w = (mean_a * mean_a + self.current.ripple_a2) * self.resistance_ohm;
        let mut to_room_w =
            -(self.stack.sink.source + self.stack.sink.feedback * self.stack.mean_sink_c());
        for z in 0..ZONES {
            to_room_w -=
                self.stack.source[0][z] + self.stack.feedback[0][z] * self.stack.mean_c(0, z);
        }
        Energy {
            electrical_j: step_s * (mean_a * seebeck_v + joule_w),
            to_room_j: step_s * to_room_w,
            from_finger_j: 0.0,
        }
    }

    /// Mean temperature of the node under the finger over the last step, deg C.
    #[must_use]
    pub fn mean_patch_c(&self) -> f64 {
        self.stack.mean_c(0, PATCH)
    }

    /// Temperature of the node under the finger, deg C.
    #[must_use]
    pub fn patch_c(&self) -> f64 {
        self.stack.node_c(0, PATCH)
    }

    /// From the patch's surface to that node, K/W.
    #[must_use]
    pub fn patch_half_k_w(&self) -> f64 {
        self.surface_m / (self.params.ceramic_w_mk * self.zones.area_m2[PATCH])
    }

    /// Current that flows; positive cools the display.
    #[must_use]
    pub const fn current(&self) -> Current {
        self.current
    }

    /// Heat capacity, J/K, and temperature, deg C, of every node.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        self.stack.nodes()
    }

    /// Temperature of the sink, deg C.
    #[must_use]
    pub fn sink_c(&self) -> f64 {
        self.stack.sink_c()
    }
}

#[cfg(test)]
mod tests;

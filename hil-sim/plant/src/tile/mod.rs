//! Thermoelectric tile between the display surface and the coolant of the sink.
//!
//! ```text
//! plate (4 cells) - tab - legs (5 cells) - tab - plate (1 cell) - sink - coolant
//! ```
//!
//! The network has three lateral zones, the patch under the finger and two rings, coupled by the plates. All legs carry
//! the same current `I`. With the Seebeck coefficient `a(T)` between two nodes, a node of the legs receives
//! `-I T (a_after - a_before)` (Thomson heat) and a tab `-I a T` or `+I a T` (Peltier heat); Joule heat is released along
//! the legs. The sum of these is the electrical power. With constant properties, the steady state at the cold tab is
//! `Qc = a I Tc - I^2 R/2 - K (Th - Tc)`.

mod bismuth_telluride;
mod cooling;
mod defect;
mod network;
mod params;
mod zones;

pub use cooling::CoolingDefects;
pub use defect::ModuleDefect;
pub use params::{TileParams, ZERO_C_K};

use super::bridge::{Current, Load};
use super::energy::Energy;
use super::slab::Cell;
use bismuth_telluride::LegProperties;
use cooling::THERMOSTAT_W_K;
use network::ThermalNetwork;
use zones::{ZONES, Zones};

/// Cells through the display plate, each twice as thick as the one above it, and cells along the legs.
const PLATE_CELLS: usize = 4;
const PLATE_GROWTH: f64 = 2.0;
const LEG_CELLS: usize = 5;

const COLD_TAB: usize = PLATE_CELLS;
const HOT_TAB: usize = COLD_TAB + LEG_CELLS + 1;
const HOT_PLATE: usize = HOT_TAB + 1;
const LEVELS: usize = HOT_PLATE + 1;
/// Links along the legs, from the cold tab to the hot one.
const LINKS: usize = LEG_CELLS + 1;
/// The zone under the finger.
const PATCH: usize = 0;

/// Cells of the display plate, from the surface on.
fn display_plate(params: &TileParams) -> [Cell; PLATE_CELLS] {
    let widths: [f64; PLATE_CELLS] = std::array::from_fn(|i| PLATE_GROWTH.powi(i as i32));
    let unit_m = params.ceramic_m / widths.iter().sum::<f64>();
    widths.map(|width| Cell::graded(unit_m * width, PLATE_GROWTH))
}

/// The tile of one finger with its sink.
#[derive(Clone, Debug)]
pub struct Tile {
    params: TileParams,
    zones: Zones,
    legs: LegProperties,
    network: ThermalNetwork<LEVELS, ZONES, COLD_TAB, HOT_TAB>,
    room_c: f64,
    defect: ModuleDefect,
    current: Current,
    /// Depth of the first node below the display surface, m.
    surface_m: f64,
    /// Fraction of the legs under each zone.
    share: [f64; ZONES],
    /// Seebeck coefficient of each link, V/K, and, of the whole module, resistance and Seebeck voltage.
    seebeck_v_k: [[f64; ZONES]; LINKS],
    resistance_ohm: f64,
    seebeck_v: f64,
    joule_w_a2: [[f64; ZONES]; LEG_CELLS],
}

impl Tile {
    /// A tile without current at the temperature of its coolant, in a room, deg C.
    pub fn new(params: TileParams, room_c: f64) -> Self {
        let zones = Zones::new(&params);
        let share = zones.area_m2.map(|m2| m2 / params.plate_m2());
        let mut network = ThermalNetwork::new(room_c + params.coolant_k);
        let plate = display_plate(&params);
        for (z, m2) in zones.area_m2.into_iter().enumerate() {
            let sheet_w = params.ceramic_w_mk * m2;
            // Display plate, the surface first; its last cell goes to the tab.
            for (level, cell) in plate.iter().enumerate() {
                let next_m = plate.get(level + 1).map_or(0.0, |next| next.node_m);
                network.capacity[level][z] = params.ceramic_j_m3k * m2 * cell.width_m;
                network.axial[level][z] = sheet_w / (cell.width_m - cell.node_m + next_m);
                network.lateral[level][z] = params.ceramic_w_mk * cell.width_m * zones.shape[z];
            }
            for level in COLD_TAB..=HOT_TAB {
                network.capacity[level][z] = match level {
                    COLD_TAB | HOT_TAB => params.tabs_j_k * share[z],
                    _ => params.legs_j_k * share[z] / LEG_CELLS as f64,
                };
            }
            // The hot plate is one cell.
            let half_k_w = 0.5 * params.ceramic_m / sheet_w;
            network.axial[HOT_TAB][z] = 1.0 / half_k_w;
            network.capacity[HOT_PLATE][z] = params.ceramic_j_m3k * m2 * params.ceramic_m;
            network.lateral[HOT_PLATE][z] = params.ceramic_w_mk * params.ceramic_m * zones.shape[z];
            network.axial[HOT_PLATE][z] = 1.0 / (half_k_w + 1.0 / (params.paste_w_k * share[z]));
        }
        network.sink.capacity = params.sink_j_k;
        let mut tile = Self {
            params,
            zones,
            legs: LegProperties::new(params.sheet_hot_c, params.variation),
            network,
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
        tile.set_cooling(&CoolingDefects::NONE);
        tile
    }

    /// Sets the defects of the sink's cooling.
    pub fn set_cooling(&mut self, defects: &CoolingDefects) {
        let coolant_c = defects.coolant_c.unwrap_or(self.room_c + self.params.coolant_k);
        let (to_c, k_w) = match defects.held_c {
            Some(held_c) => (held_c, THERMOSTAT_W_K.recip()),
            None => (coolant_c, self.params.sink_k_w * defects.resistance_factor),
        };
        self.network.sink.source = to_c / k_w;
        self.network.sink.feedback = -1.0 / k_w;
    }

    /// Sets the defect of the module.
    pub const fn set_defect(&mut self, defect: ModuleDefect) {
        self.defect = defect;
    }

    /// Sets the area of the patch that the finger covers, m2; the rest of the plate exchanges heat with the air.
    pub fn cover(&mut self, area_m2: f64) {
        for (z, m2) in self.zones.area_m2.into_iter().enumerate() {
            let free_m2 = if z == PATCH { (m2 - area_m2).max(0.0) } else { m2 };
            let film_w_k = self.params.film_w_m2k * free_m2;
            self.network.source[0][z] = film_w_k * self.room_c;
            self.network.feedback[0][z] = -film_w_k;
        }
    }

    /// Film coefficient of air on the display plate, W/(m2 K).
    pub const fn film_w_m2k(&self) -> f64 {
        self.params.film_w_m2k
    }

    /// Updates the properties of the legs for the middle of the coming step, s.
    pub fn prepare(&mut self, step_s: f64) {
        let (all_ohm, all_w_k, all_v_k) = (
            self.params.resistance_ohm() / LEG_CELLS as f64,
            self.params.conductance_w_k() * LEG_CELLS as f64,
            self.params.seebeck_v_k() * self.defect.seebeck,
        );
        (self.resistance_ohm, self.seebeck_v) = (0.0, 0.0);
        for z in 0..ZONES {
            let share = self.share[z];
            let mut here_c = self.network.extrapolated_c(COLD_TAB, z, step_s);
            for link in 0..LINKS {
                let next_c = self.network.extrapolated_c(COLD_TAB + link + 1, z, step_s);
                let between_c = 0.5 * (here_c + next_c);
                let half_cell = if link == 0 || link + 1 == LINKS { 2.0 } else { 1.0 };
                self.network.axial[COLD_TAB + link][z] =
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

    /// Electrical load of the [prepared](Self::prepare) step; the Seebeck voltage opposes a cooling current.
    pub const fn load(&self) -> Load {
        Load { seebeck_v: self.seebeck_v, resistance_ohm: self.resistance_ohm }
    }

    /// Sets the current of the coming step; positive cools the display.
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
                self.network.feedback[COLD_TAB + node][z] = feedback_w_k;
                self.network.source[COLD_TAB + node][z] = joule_w + feedback_w_k * ZERO_C_K;
                before_w_k = after_w_k;
            }
        }
    }

    /// First stage of a step, s, with a power into the node under the finger, W, and the contributions of the eliminated
    /// finger to the equation of that node: pivot, W/K, and right-hand side, W. Returns the increment of the node, K.
    pub fn first_stage(&mut self, step_s: f64, inflow_w: f64, pivot_w_k: f64, rhs_w: f64) -> f64 {
        self.network.first_stage(step_s, inflow_w, pivot_w_k, rhs_w)
    }

    /// Second stage, which ends the step, with the finger's contribution to the right-hand side, W. Returns the increment, K.
    pub fn second_stage(&mut self, rhs_w: f64) -> f64 {
        self.network.second_stage(rhs_w)
    }

    /// Energy that crossed the boundaries of the tile in the last step, s, without the finger's heat.
    pub fn step_energy(&self, step_s: f64) -> Energy {
        let mut seebeck_v = 0.0;
        for (link, across) in self.seebeck_v_k.iter().enumerate() {
            for (z, seebeck) in across.iter().enumerate() {
                let [here_c, next_c] = [0, 1].map(|i| self.network.mean_c(COLD_TAB + link + i, z));
                seebeck_v += seebeck * (next_c - here_c);
            }
        }
        let mean_a = self.current.mean_a;
        let joule_w = (mean_a * mean_a + self.current.ripple_a2) * self.resistance_ohm;
        let mut to_room_w =
            -(self.network.sink.source + self.network.sink.feedback * self.network.mean_sink_c());
        for z in 0..ZONES {
            to_room_w -=
                self.network.source[0][z] + self.network.feedback[0][z] * self.network.mean_c(0, z);
        }
        Energy {
            electrical_j: step_s * (mean_a * seebeck_v + joule_w),
            to_room_j: step_s * to_room_w,
            from_finger_j: 0.0,
        }
    }

    /// Mean temperature of the node under the finger over the last step, deg C.
    pub fn mean_patch_c(&self) -> f64 {
        self.network.mean_c(0, PATCH)
    }

    /// Temperature of the node under the finger, deg C.
    pub fn patch_c(&self) -> f64 {
        self.network.node_c(0, PATCH)
    }

    /// Thermal resistance from the surface of the patch to the node under the finger, K/W.
    pub fn patch_half_k_w(&self) -> f64 {
        self.surface_m / (self.params.ceramic_w_mk * self.zones.area_m2[PATCH])
    }

    /// Present current; positive cools the display.
    pub const fn current(&self) -> Current {
        self.current
    }

    /// Heat capacity, J/K, and temperature, deg C, of every node.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        self.network.nodes()
    }

    /// Temperature of the sink, deg C.
    pub fn sink_c(&self) -> f64 {
        self.network.sink_c()
    }
}

#[cfg(test)]
mod tests;

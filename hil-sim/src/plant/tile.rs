//! The thermoelectric tile between the display's face and its sink.
//!
//! ```text
//! face (3 cells) - tab - legs (6 cells) - tab - face (3 cells) - sink - room
//! ```
//!
//! The Peltier effect acts where legs meet tabs, Joule heat arises along the legs: at rest this is
//! `Qc = a I Tc - I^2 R/2 - K (Th - Tc)` at the tabs, and after a change of current Joule heat reaches the face
//! only as fast as the legs conduct it. Material constants do not depend on temperature here (no Thomson effect).

use super::bridge::{Current, Load};
use super::chain::{Chain, Link};

/// Cells through one ceramic face.
const FACE_CELLS: usize = 3;
/// Cells along the legs.
const LEG_CELLS: usize = 6;

const COLD_TAB: usize = FACE_CELLS;
const LEGS: usize = COLD_TAB + 1;
const HOT_TAB: usize = LEGS + LEG_CELLS;
const SINK: usize = HOT_TAB + 1 + FACE_CELLS;
/// Nodes of a tile with its sink.
pub const NODES: usize = SINK + 1;

/// 0 deg C in kelvin.
const ZERO_C_K: f64 = 273.15;

/// What a tile and its sink are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileParams {
    /// Seebeck coefficient of all couples, V/K.
    pub seebeck_v_k: f64,
    /// Electrical resistance, ohm.
    pub resistance_ohm: f64,
    /// Thermal conductance of the legs, W/K.
    pub conductance_w_k: f64,
    /// Heat capacity of the legs, J/K.
    pub legs_j_k: f64,
    /// Heat capacity of the copper tabs of one side, J/K.
    pub tabs_j_k: f64,
    /// Heat capacity of one ceramic face, J/K.
    pub face_j_k: f64,
    /// Thermal conductance through one ceramic face, W/K.
    pub face_w_k: f64,
    /// From the hot face to the sink, W/K.
    pub paste_w_k: f64,
    /// Heat capacity of the sink, J/K.
    pub sink_j_k: f64,
    /// From the sink to the room, K/W.
    pub sink_k_w: f64,
}

impl TileParams {
    /// Class values of a module of 71 couples, 30 mm x 30 mm with 0.8 mm alumina faces, rated 6 A, 8.2 V and 67 K,
    /// on a fan-cooled sink. They are recalled from data sheets of the class, not measured.
    pub const CLASS: Self = Self {
        seebeck_v_k: 0.0273,
        resistance_ohm: 1.061,
        conductance_w_k: 0.285,
        legs_j_k: 0.51,
        tabs_j_k: 0.52,
        face_j_k: 2.2,
        face_w_k: 40.0,
        paste_w_k: 100.0,
        sink_j_k: 200.0,
        sink_k_w: 0.15,
    };

    /// Heat capacities from the display's face to the sink, J/K.
    #[must_use]
    pub fn capacities_j_k(&self) -> [f64; NODES] {
        let mut c = [self.face_j_k / FACE_CELLS as f64; NODES];
        c[COLD_TAB] = self.tabs_j_k;
        c[LEGS..HOT_TAB].fill(self.legs_j_k / LEG_CELLS as f64);
        c[HOT_TAB] = self.tabs_j_k;
        c[SINK] = self.sink_j_k;
        c
    }

    /// Links from the display's face to the sink.
    #[must_use]
    pub fn links(&self) -> [Link; NODES - 1] {
        let in_face = Link::symmetric(self.face_w_k * FACE_CELLS as f64);
        let half_face = Link::symmetric(1.0 / self.half_cell_k_w());
        let half_leg = Link::symmetric(self.conductance_w_k * 2.0 * LEG_CELLS as f64);
        let mut links = [in_face; NODES - 1];
        links[COLD_TAB - 1] = half_face;
        links[COLD_TAB] = half_leg;
        links[LEGS..HOT_TAB].fill(Link::symmetric(self.conductance_w_k * LEG_CELLS as f64));
        links[HOT_TAB - 1] = half_leg;
        links[HOT_TAB] = half_face;
        links[SINK - 1] = Link::symmetric(1.0 / (self.half_cell_k_w() + 1.0 / self.paste_w_k));
        links
    }

    /// From a surface of a face to the middle of its first cell, K/W.
    #[must_use]
    pub fn half_cell_k_w(&self) -> f64 {
        0.5 / (self.face_w_k * FACE_CELLS as f64)
    }
}

/// A tile whose nodes are the last of a chain.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    params: TileParams,
    /// The node of the chain at the display's surface.
    face: usize,
    current: Current,
}

impl Tile {
    /// The tile whose display face begins at node `face`, without current.
    #[must_use]
    pub const fn new(params: TileParams, face: usize) -> Self {
        Self {
            params,
            face,
            current: Current {
                mean_a: 0.0,
                ripple_a2: 0.0,
                mirror_a: 0.0,
            },
        }
    }

    /// What it is to the bridge at the present temperatures.
    #[must_use]
    pub fn load(&self, chain: &Chain) -> Load {
        let rise_c = chain.temperature_c(self.face + HOT_TAB) - chain.temperature_c(self.face + COLD_TAB);
        Load {
            seebeck_v: self.params.seebeck_v_k * rise_c,
            resistance_ohm: self.params.resistance_ohm,
        }
    }

    /// Lets a current flow, with the sink in a room of the given temperature, deg C.
    pub fn drive(&mut self, chain: &mut Chain, current: &Current, room_c: f64) {
        self.current = *current;
        let current_a = current.mean_a;
        let peltier_w_k = self.params.seebeck_v_k * current_a;
        chain.set_source(self.face + COLD_TAB, -peltier_w_k * ZERO_C_K, -peltier_w_k);
        let joule_w = self.joule_w() / LEG_CELLS as f64;
        for leg in LEGS..HOT_TAB {
            chain.set_source(self.face + leg, joule_w, 0.0);
        }
        chain.set_source(self.face + HOT_TAB, peltier_w_k * ZERO_C_K, peltier_w_k);
        let sink_w_k = 1.0 / self.params.sink_k_w;
        chain.set_source(self.face + SINK, sink_w_k * room_c, -sink_w_k);
    }

    /// Joule heat, that of the ripple included, W.
    fn joule_w(&self) -> f64 {
        let Current {
            mean_a, ripple_a2, ..
        } = self.current;
        (mean_a * mean_a + ripple_a2) * self.params.resistance_ohm
    }

    /// Electrical power taken up, mean over the last step, W.
    #[must_use]
    pub fn electrical_w(&self, chain: &Chain) -> f64 {
        let rise_c = chain.mean_c(self.face + HOT_TAB) - chain.mean_c(self.face + COLD_TAB);
        self.current.mean_a * self.params.seebeck_v_k * rise_c + self.joule_w()
    }

    /// Heat that goes to the room, mean over the last step, W.
    #[must_use]
    pub fn to_room_w(&self, chain: &Chain, room_c: f64) -> f64 {
        (chain.mean_c(self.face + SINK) - room_c) / self.params.sink_k_w
    }

    /// Temperature of the sink, deg C.
    #[must_use]
    pub fn sink_c(&self, chain: &Chain) -> f64 {
        chain.temperature_c(self.face + SINK)
    }
}

#[cfg(test)]
mod tests;

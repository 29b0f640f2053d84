//! The finger on the display.

use super::bridge::{Current, Load};
use super::chain::{Chain, Link};
use super::half_space::HalfSpace;
use super::tile::{self, Tile, TileParams};
use super::touch::Touch;

/// What has crossed the tile's borders so far, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Electrical work taken up.
    pub electrical_j: f64,
    /// Heat given by the finger.
    pub from_finger_j: f64,
    /// Heat given to the room.
    pub to_room_j: f64,
}

/// A finger on the tile: one implicit chain from the depth of the finger to the sink, so that what the current
/// changes in each step comes last. The finger counts per square metre of contact, the tile whole: when the contact
/// grows, tissue of the same temperatures joins.
#[derive(Clone, Debug)]
pub struct FingerOnDisplay {
    chain: Chain,
    tile: Tile,
    room_c: f64,
    /// The skin's surface cell; the next node is the display's.
    skin: usize,
    skin_half_m2k_w: f64,
    face_half_k_w: f64,
    energy: Energy,
}

impl FingerOnDisplay {
    /// Apart: the finger at its temperature, the tile and its sink at that of the room, deg C.
    #[must_use]
    pub fn new(params: TileParams, skin: &HalfSpace, skin_c: f64, room_c: f64) -> Self {
        let capacity = skin
            .capacity_j_m2k
            .iter()
            .rev()
            .chain(&params.capacities_j_k())
            .copied()
            .collect();
        let links: Vec<Link> = skin
            .links
            .iter()
            .rev()
            .chain([&Link::OPEN])
            .chain(&params.links())
            .copied()
            .collect();
        let mut start_c = vec![skin_c; skin.cells()];
        start_c.resize(skin.cells() + tile::NODES, room_c);
        Self {
            chain: Chain::new(capacity, &links, start_c),
            tile: Tile::new(params, skin.cells()),
            room_c,
            skin: skin.cells() - 1,
            skin_half_m2k_w: skin.half_cell_m2k_w,
            face_half_k_w: params.half_cell_k_w(),
            energy: Energy::default(),
        }
    }

    /// Closes, changes or opens the contact.
    pub fn touch(&mut self, touch: Option<Touch>) {
        let link = touch.map_or(Link::OPEN, |t| {
            let resistance = self.skin_half_m2k_w + t.resistance_m2k_w + self.face_half_k_w * t.area_m2;
            Link {
                ahead: 1.0 / resistance,
                behind: t.area_m2 / resistance,
            }
        });
        self.chain.set_link(self.skin, link);
    }

    /// The tile as the bridge sees it now.
    #[must_use]
    pub fn load(&self) -> Load {
        self.tile.load(&self.chain)
    }

    /// Advances by one step, s, with a current held.
    pub fn step(&mut self, step_s: f64, current: &Current) {
        self.tile.drive(&mut self.chain, current, self.room_c);
        self.chain.step(step_s);
        let from_finger_w = self.chain.link(self.skin).behind
            * (self.chain.mean_c(self.skin) - self.chain.mean_c(self.skin + 1));
        self.energy.electrical_j += step_s * self.tile.electrical_w(&self.chain);
        self.energy.from_finger_j += step_s * from_finger_w;
        self.energy.to_room_j += step_s * self.tile.to_room_w(&self.chain, self.room_c);
    }

    fn fall_c(&self) -> f64 {
        self.chain.temperature_c(self.skin) - self.chain.temperature_c(self.skin + 1)
    }

    /// Heat flux out of the skin, W/m2.
    #[must_use]
    pub fn flux_w_m2(&self) -> f64 {
        self.chain.link(self.skin).ahead * self.fall_c()
    }

    /// Temperature of the skin's surface, deg C.
    #[must_use]
    pub fn skin_c(&self) -> f64 {
        self.chain.temperature_c(self.skin) - self.flux_w_m2() * self.skin_half_m2k_w
    }

    /// Temperature of the display's surface, deg C.
    #[must_use]
    pub fn display_c(&self) -> f64 {
        let power_w = self.chain.link(self.skin).behind * self.fall_c();
        self.chain.temperature_c(self.skin + 1) + power_w * self.face_half_k_w
    }

    /// Temperature of the sink, deg C.
    #[must_use]
    pub fn sink_c(&self) -> f64 {
        self.tile.sink_c(&self.chain)
    }

    /// What has crossed the tile's borders so far.
    #[must_use]
    pub const fn energy(&self) -> Energy {
        self.energy
    }
}

#[cfg(test)]
mod tests;

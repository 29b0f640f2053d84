//! The truth to be matched: the same finger on the real material.

use super::chain::{Chain, Link};
use super::half_space::HalfSpace;
use super::touch::Touch;

/// A finger on a deep object, per square metre of contact, whatever its area. The object's depth comes first in the
/// chain, the finger's last; both are insulated while they do not touch.
#[derive(Clone, Debug)]
pub struct FingerOnObject {
    chain: Chain,
    /// The object's surface cell; the next node is the skin's.
    surface: usize,
    object_half_m2k_w: f64,
    skin_half_m2k_w: f64,
    /// They have touched. Before, each is at one temperature and insulated, so nothing moves.
    touched: bool,
}

impl FingerOnObject {
    /// Apart, at their temperatures, deg C.
    #[must_use]
    pub fn new(object: &HalfSpace, object_c: f64, skin: &HalfSpace, skin_c: f64) -> Self {
        let capacity = object
            .capacity_j_m2k
            .iter()
            .rev()
            .chain(&skin.capacity_j_m2k)
            .copied()
            .collect();
        let links: Vec<Link> = object
            .links
            .iter()
            .rev()
            .chain([&Link::OPEN])
            .chain(&skin.links)
            .copied()
            .collect();
        let mut start_c = vec![object_c; object.cells()];
        start_c.resize(object.cells() + skin.cells(), skin_c);
        Self {
            chain: Chain::new(capacity, &links, start_c),
            surface: object.cells() - 1,
            object_half_m2k_w: object.half_cell_m2k_w,
            skin_half_m2k_w: skin.half_cell_m2k_w,
            touched: false,
        }
    }

    /// Closes, changes or opens the contact.
    pub fn touch(&mut self, touch: Option<Touch>) {
        let link = touch.map_or(Link::OPEN, |t| {
            Link::symmetric(1.0 / (self.object_half_m2k_w + t.resistance_m2k_w + self.skin_half_m2k_w))
        });
        self.touched |= touch.is_some();
        self.chain.set_link(self.surface, link);
    }

    /// Advances by one step, s.
    pub fn step(&mut self, step_s: f64) {
        if self.touched {
            self.chain.step(step_s);
        }
    }

    /// Heat flux out of the skin, W/m2.
    #[must_use]
    pub fn flux_w_m2(&self) -> f64 {
        let fall_c = self.chain.temperature_c(self.surface + 1) - self.chain.temperature_c(self.surface);
        self.chain.link(self.surface).ahead * fall_c
    }

    /// Temperature of the skin's surface, deg C.
    #[must_use]
    pub fn skin_c(&self) -> f64 {
        self.chain.temperature_c(self.surface + 1) - self.flux_w_m2() * self.skin_half_m2k_w
    }

    /// Temperature of the object's surface, deg C.
    #[must_use]
    pub fn object_c(&self) -> f64 {
        self.chain.temperature_c(self.surface) + self.flux_w_m2() * self.object_half_m2k_w
    }
}

//! Temperature at a depth.

use super::Slab;

/// Nodes that a reading is drawn through: a cubic.
const NODES: usize = 4;

/// Weights of the nodes around a depth. They interpolate over thermal resistance instead of length, in which a
/// temperature has no kink between layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    first: usize,
    weights: [f64; NODES],
}

impl Probe {
    /// A reading at a depth, m, of a slab with at least four cells; none outside of the slab.
    #[must_use]
    pub fn at(slab: &Slab, depth_m: f64) -> Option<Self> {
        let above = slab.depth_m.partition_point(|d| *d <= depth_m);
        let first = above
            .saturating_sub(NODES / 2)
            .min(slab.cells().checked_sub(NODES)?);
        let deepest_m = slab.depth_m.last()?;
        if !(0.0..=*deepest_m).contains(&depth_m) {
            return None;
        }
        let mut place = [0.0; NODES];
        for i in 1..NODES {
            place[i] = place[i - 1] + 1.0 / slab.link_w_m2k[first + i - 1];
        }
        // Between two nodes of one layer resistance is in proportion to length, as it is above the first node.
        let wanted = match above.checked_sub(first + 1) {
            None => -slab.surface_m2k_w * (1.0 - depth_m / slab.depth_m[first]),
            Some(i) if i + 1 < NODES => {
                let (near, far) = (slab.depth_m[first + i], slab.depth_m[first + i + 1]);
                place[i] + (place[i + 1] - place[i]) * (depth_m - near) / (far - near)
            }
            Some(_) => place[NODES - 1],
        };
        let weights = std::array::from_fn(|i| {
            (0..NODES)
                .filter(|j| *j != i)
                .map(|j| (wanted - place[j]) / (place[i] - place[j]))
                .product()
        });
        Some(Self { first, weights })
    }

    /// The reading, of the temperature of each node (the first is the nearest to the surface), deg C.
    #[must_use]
    pub fn read(&self, node_c: impl Fn(usize) -> f64) -> f64 {
        let weighted = self.weights.iter().enumerate();
        weighted.map(|(i, w)| w * node_c(self.first + i)).sum()
    }
}

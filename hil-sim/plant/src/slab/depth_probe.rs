//! Interpolation of the temperature at a depth.

use super::Slab;

/// Nodes of the cubic interpolation.
const NODES: usize = 4;

/// Interpolation weights of the nodes around a depth. The coordinate is thermal resistance instead of length, over which
/// a temperature profile has no kink at the boundary of two layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthProbe {
    first: usize,
    weights: [f64; NODES],
}

impl DepthProbe {
    /// A probe at a depth, m, of a slab with at least four cells; none outside of the slab.
    pub fn at(slab: &Slab, depth_m: f64) -> Option<Self> {
        let above = slab.depth_m.partition_point(|d| *d <= depth_m);
        let first = above.saturating_sub(NODES / 2).min(slab.cells().checked_sub(NODES)?);
        let deepest_m = slab.depth_m.last()?;
        if !(0.0..=*deepest_m).contains(&depth_m) {
            return None;
        }
        let mut positions = [0.0; NODES];
        for i in 1..NODES {
            positions[i] = positions[i - 1] + 1.0 / slab.link_w_m2k[first + i - 1];
        }
        // Between two nodes of one layer, and above the first node, resistance is proportional to length.
        let position = match above.checked_sub(first + 1) {
            None => -slab.surface_m2k_w * (1.0 - depth_m / slab.depth_m[first]),
            Some(i) if i + 1 < NODES => {
                let (near, far) = (slab.depth_m[first + i], slab.depth_m[first + i + 1]);
                positions[i] + (positions[i + 1] - positions[i]) * (depth_m - near) / (far - near)
            }
            Some(_) => positions[NODES - 1],
        };
        let weights = std::array::from_fn(|i| {
            (0..NODES)
                .filter(|j| *j != i)
                .map(|j| (position - positions[j]) / (positions[i] - positions[j]))
                .product()
        });
        Some(Self { first, weights })
    }

    /// Interpolated temperature, deg C; `node_c` gives that of a node, counted from the surface.
    pub fn read(&self, node_c: impl Fn(usize) -> f64) -> f64 {
        let weighted = self.weights.iter().enumerate();
        weighted.map(|(i, w)| w * node_c(self.first + i)).sum()
    }
}

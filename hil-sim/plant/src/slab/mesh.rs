//! Where to cut a slab that heat enters through its surface.
//!
//! What happens a time `t` after a contact happens within a few diffusion lengths `sqrt(a t)`: cells that grow by
//! a constant factor resolve every time alike. Each cell's node lies at the geometric mean of its faces, seen from
//! the point where the row of cells would shrink to nothing, so that nodes and faces are two rows of the same
//! factor. Against nodes in the middle this costs nothing and makes the surface of a half-space follow the exact
//! one but for a ripple that vanishes faster than any power of `growth - 1` (Ingerman, Druskin and Knizhnerman,
//! 2000, on optimal grids): 2e-7 of its impedance at a factor of 1.2, where the middle is off by 2e-3. Inside, and
//! in layers, the mesh is of second order as usual.

/// How finely a slab is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grading {
    /// Width of the cell at the surface in diffusion lengths of one second, s^1/2.
    pub first: f64,
    /// Each cell against the one before it, above 1.
    pub growth: f64,
    /// Depth of a half-space in diffusion lengths of the whole duration. The surface notices the insulated back by
    /// way of twice that, as `erfc(4) = 1.5e-8` of a step.
    pub depth: f64,
}

impl Grading {
    /// What every run uses. The surface cell is the diffusion length of 4 us: its error falls with `a t / width^2`.
    pub const RUN: Self = Self {
        first: 0.002,
        growth: 1.12,
        depth: 4.0,
    };
}

/// Width of a cell and the distance of its node from the face towards the surface, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Width.
    pub width_m: f64,
    /// From the face towards the surface to the node.
    pub node_m: f64,
}

impl Cell {
    /// A cell in a row in which each is `growth` times as wide as the one before.
    #[must_use]
    pub fn graded(width_m: f64, growth: f64) -> Self {
        Self {
            width_m,
            node_m: width_m / (1.0 + growth.sqrt()),
        }
    }
}

/// Cells that fill a thickness, the first at most `first_m` wide and each 1 to `growth` times the one before.
#[must_use]
pub fn fill(thickness_m: f64, first_m: f64, growth: f64) -> Vec<Cell> {
    // The geometric sum, read backwards; a hair less, so that a row that fits is not given one cell more.
    let cells = ((thickness_m / first_m * (growth - 1.0)).ln_1p() / growth.ln() - 1e-9).ceil();
    if cells <= 1.0 {
        return vec![Cell::graded(thickness_m, 1.0)];
    }
    let sum = |g: f64| (0..cells as i32).map(|i| g.powi(i)).sum::<f64>();
    // The factor with which they fill it: the sum rises with it.
    let (mut least, mut most) = (1.0, growth);
    while most - least > 1e-15 * most {
        let middle = 0.5 * (least + most);
        if middle <= least || middle >= most {
            break;
        }
        if sum(middle) * first_m < thickness_m {
            least = middle;
        } else {
            most = middle;
        }
    }
    let g = if sum(1.0) * first_m > thickness_m {
        1.0
    } else {
        most
    };
    // Even cells may have to be narrower; and what the factor's rounding leaves goes to all alike.
    let first_m = thickness_m / sum(g);
    (0..cells as i32)
        .map(|i| Cell::graded(first_m * g.powi(i), g))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_the_thickness_and_grow_as_asked() {
        for thickness_m in [1e-5, 1.01e-4, 2.5e-4, 1e-3, 0.07] {
            let cells = fill(thickness_m, 1e-4, 1.15);
            let sum: f64 = cells.iter().map(|c| c.width_m).sum();
            assert!(
                (sum / thickness_m - 1.0).abs() < 1e-14,
                "{thickness_m}: {sum}"
            );
            for pair in cells.windows(2) {
                assert!(pair[1].width_m / pair[0].width_m < 1.15 + 1e-12);
            }
            for c in &cells {
                assert!(c.node_m > 0.4 * c.width_m && c.node_m < 0.6 * c.width_m);
            }
        }
    }

    #[test]
    fn whole_rows_keep_first_width_and_factor() {
        let thickness_m: f64 = (0..30).map(|i| 2e-6 * 1.2f64.powi(i)).sum();
        let cells = fill(thickness_m, 2e-6, 1.2);
        assert_eq!(cells.len(), 30);
        assert!((cells[0].width_m / 2e-6 - 1.0).abs() < 1e-9);
    }

    /// Impedance of a half-space of unit properties at a rate `s` of growth: exact is `1/sqrt(s)`.
    fn impedance(growth: f64, s: f64, node: fn(&Cell) -> f64) -> f64 {
        let cells = fill(1e9, 1.0, growth);
        let mut admittance = 0.0;
        for (i, cell) in cells.iter().enumerate().rev() {
            let before = i
                .checked_sub(1)
                .map_or(0.0, |b| cells[b].width_m - node(&cells[b]));
            admittance = 1.0 / (1.0 / (admittance + s * cell.width_m) + before + node(cell));
        }
        1.0 / admittance
    }

    #[test]
    fn nodes_at_the_geometric_mean_follow_a_half_space() {
        // Over one period of the row's self-similarity, far from both of its ends.
        let worst = |growth: f64, node| {
            (0..12)
                .map(|k| 1e-8 * growth.powf(f64::from(k) / 6.0))
                .map(|s| (impedance(growth, s, node) * s.sqrt() - 1.0).abs())
                .fold(0.0, f64::max)
        };
        assert!(worst(1.15, |c| c.node_m) < 2e-8);
        assert!(
            worst(1.15, |c| 0.5 * c.width_m) > 1e-3,
            "nodes in the middle"
        );
    }
}

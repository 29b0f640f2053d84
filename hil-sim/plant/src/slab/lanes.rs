//! Slabs side by side, advanced in lockstep.
//!
//! Elimination runs from the depth of every slab to its surface, and what touches a surface closes the rows that are
//! left, one a slab. So the rows below depend on nothing that a contact changes: they are eliminated once for each
//! length of step. The recurrence from node to node waits for every result; slabs in the lanes of one vector
//! share that wait.

use super::Slab;
use crate::scheme;

/// What is left of a slab when all but its surface cell are eliminated: `pivot x = rhs + what comes in`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Coefficient of the surface cell's increment, W/(m2 K).
    pub pivot: f64,
    /// Right-hand side, W/m2.
    pub rhs: f64,
}

/// Elimination for one length of step.
#[derive(Clone, Debug)]
struct Factors<const L: usize> {
    step_s: f64,
    /// Coefficients have changed since.
    stale: bool,
    inertia: Vec<[f64; L]>,
    inverse: Vec<[f64; L]>,
    /// Of the surface cells.
    pivot: [f64; L],
    /// Of the deeper neighbour's result, and of the nearer neighbour's.
    deeper: Vec<[f64; L]>,
    nearer: Vec<[f64; L]>,
}

/// `L` slabs. Nodes are held from the depth to the surface; slabs of fewer cells have inert ones at their back.
#[derive(Clone, Debug)]
pub struct Lanes<const L: usize> {
    cells: usize,
    capacity: Vec<[f64; L]>,
    /// From each node to the next nearer one; the last is the surface's and open.
    link: Vec<[f64; L]>,
    metabolism: Vec<[f64; L]>,
    blood: Vec<[f64; L]>,
    /// From the deepest node of each slab to what lies behind it, and its temperature.
    back: [(usize, f64, f64); L],
    /// Share of full flow and temperature of the blood.
    flow: [f64; L],
    blood_c: [f64; L],
    source: Vec<[f64; L]>,
    feedback: Vec<[f64; L]>,
    temperature: Vec<[f64; L]>,
    power: Vec<[f64; L]>,
    first: Vec<[f64; L]>,
    second: Vec<[f64; L]>,
    factors: Vec<Factors<L>>,
}

impl<const L: usize> Lanes<L> {
    /// The slabs at one temperature each, deg C, which is that of their blood too; `steps_s` are the lengths of step
    /// that will be asked for.
    #[must_use]
    pub fn new(slabs: [&Slab; L], start_c: [f64; L], steps_s: &[f64]) -> Self {
        let cells = slabs.iter().map(|s| s.cells()).max().unwrap_or(0);
        let column = |filler: f64, part: &dyn Fn(&Slab) -> Vec<f64>| {
            let mut column = vec![[filler; L]; cells];
            for (lane, slab) in slabs.iter().enumerate() {
                for (row, value) in column.iter_mut().rev().zip(part(slab)) {
                    row[lane] = value;
                }
            }
            column
        };
        let factors = steps_s.iter().map(|&step_s| Factors {
            step_s,
            stale: true,
            inertia: vec![[0.0; L]; cells],
            inverse: vec![[0.0; L]; cells],
            pivot: [0.0; L],
            deeper: vec![[0.0; L]; cells],
            nearer: vec![[0.0; L]; cells],
        });
        let mut lanes = Self {
            cells,
            capacity: column(1.0, &|s| s.capacity_j_m2k.clone()),
            link: column(0.0, &|s| [&[0.0], s.link_w_m2k.as_slice()].concat()),
            metabolism: column(0.0, &|s| s.metabolism_w_m2.clone()),
            blood: column(0.0, &|s| s.blood_w_m2k.clone()),
            back: slabs.map(|s| (cells - s.cells(), s.back.0, s.back.1)),
            flow: [1.0; L],
            blood_c: start_c,
            source: vec![[0.0; L]; cells],
            feedback: vec![[0.0; L]; cells],
            temperature: vec![start_c; cells],
            power: vec![[0.0; L]; cells],
            first: vec![[0.0; L]; cells],
            second: vec![[0.0; L]; cells],
            factors: factors.collect(),
        };
        lanes.supply();
        lanes
    }

    /// Sets the share of its full flow that a lane's blood has.
    pub fn set_flow(&mut self, lane: usize, share: f64) {
        if self.flow[lane] != share {
            self.flow[lane] = share;
            self.supply();
        }
    }

    /// Sets the temperature of a lane's blood and of what lies behind it, deg C.
    pub fn set_core_c(&mut self, lane: usize, core_c: f64) {
        self.blood_c[lane] = core_c;
        self.back[lane].2 = core_c;
        self.supply();
    }

    /// Sources and feedback of every node.
    fn supply(&mut self) {
        for i in 0..self.cells {
            for lane in 0..L {
                let exchange = self.blood[i][lane] * self.flow[lane];
                self.source[i][lane] = self.metabolism[i][lane] + exchange * self.blood_c[lane];
                self.feedback[i][lane] = -exchange;
            }
        }
        for (lane, (deepest, exchange, back_c)) in self.back.into_iter().enumerate() {
            self.source[deepest][lane] += exchange * back_c;
            self.feedback[deepest][lane] -= exchange;
        }
        for factors in &mut self.factors {
            factors.stale = true;
        }
    }

    /// Number of cells of the largest slab.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.cells
    }

    /// Temperature of a node, deg C, counted from the surface.
    #[must_use]
    pub fn node_c(&self, lane: usize, node: usize) -> f64 {
        self.temperature[self.cells - 1 - node][lane]
    }

    /// Sets the temperature of a node, deg C, counted from the surface.
    pub fn set_node_c(&mut self, lane: usize, node: usize, temperature_c: f64) {
        self.temperature[self.cells - 1 - node][lane] = temperature_c;
    }

    /// Temperature of the surface cell, deg C.
    #[must_use]
    pub fn surface_c(&self, lane: usize) -> f64 {
        self.temperature[self.cells - 1][lane]
    }

    /// Mean temperature of a node over the last step, deg C.
    #[must_use]
    pub fn mean_c(&self, lane: usize, node: usize) -> f64 {
        let i = self.cells - 1 - node;
        scheme::mean(
            self.temperature[i][lane],
            self.first[i][lane],
            self.second[i][lane],
        )
    }

    /// Begins a step of the given length, an index into the lengths: what is left of each slab in the first stage,
    /// with the power that comes into its surface at the start, W/m2.
    pub fn first(&mut self, step: usize, inflow_w_m2: [f64; L]) -> [Row; L] {
        self.factor(step);
        let n = self.cells;
        let f = &self.factors[step];
        let (t, link) = (&self.temperature[..n], &self.link[..n]);
        let (source, feedback) = (&self.source[..n], &self.feedback[..n]);
        let (inverse, deeper) = (&f.inverse[..n], &f.deeper[..n]);
        let (power, first) = (&mut self.power[..n], &mut self.first[..n]);
        let mut below = [0.0; L];
        let mut carry = [0.0; L];
        for i in 0..n {
            let nearer = t[(i + 1).min(n - 1)];
            let above = each(|l| link[i][l] * (nearer[l] - t[i][l]));
            let p = each(|l| source[i][l] + feedback[i][l] * t[i][l] + above[l] - below[l]);
            below = above;
            power[i] = p;
            carry = each(|l| scheme::first(p[l]) * inverse[i][l] + deeper[i][l] * carry[l]);
            first[i] = carry;
        }
        for l in 0..L {
            let extra = inflow_w_m2[l];
            power[n - 1][l] += extra;
            carry[l] += scheme::first(extra) * inverse[n - 1][l];
        }
        self.rows(step, carry)
    }

    /// Goes on with the increments of the surface cells in the first stage: what is left in the second.
    pub fn second(&mut self, step: usize, surface: [f64; L]) -> [Row; L] {
        let n = self.cells;
        let f = &self.factors[step];
        let (inertia, inverse) = (&f.inertia[..n], &f.inverse[..n]);
        let (deeper, nearer) = (&f.deeper[..n], &f.nearer[..n]);
        let power = &self.power[..n];
        let first = &mut self.first[..n];
        substitute(nearer, surface, first);
        let second = &mut self.second[..n];
        let mut carry = [0.0; L];
        for i in 0..n {
            let rhs: [f64; L] = each(|l| scheme::second(inertia[i][l], first[i][l], power[i][l]));
            carry = each(|l| rhs[l] * inverse[i][l] + deeper[i][l] * carry[l]);
            second[i] = carry;
        }
        self.rows(step, carry)
    }

    /// Ends the step with the increments of the surface cells in the second stage.
    pub fn finish(&mut self, step: usize, surface: [f64; L]) {
        let n = self.cells;
        let second = &mut self.second[..n];
        substitute(&self.factors[step].nearer[..n], surface, second);
        let (t, first) = (&mut self.temperature[..n], &self.first[..n]);
        for i in 0..n {
            t[i] = each(|l| t[i][l] + (first[i][l] + second[i][l]));
        }
    }

    fn rows(&self, step: usize, solved: [f64; L]) -> [Row; L] {
        let pivot = &self.factors[step].pivot;
        std::array::from_fn(|l| Row {
            pivot: pivot[l],
            rhs: solved[l] * pivot[l],
        })
    }

    /// Eliminates for a length of step, if that is not done.
    fn factor(&mut self, step: usize) {
        let n = self.cells;
        let f = &mut self.factors[step];
        if !f.stale {
            return;
        }
        f.stale = false;
        for i in 0..n {
            for l in 0..L {
                let inertia = scheme::inertia(self.capacity[i][l], f.step_s);
                // Sums of positive terms: nothing cancels.
                let mut pivot = inertia + self.link[i][l] - self.feedback[i][l];
                let mut below = 0.0;
                if i > 0 {
                    below = self.link[i - 1][l];
                    pivot += below * (1.0 - f.nearer[i - 1][l]);
                }
                f.inertia[i][l] = inertia;
                f.pivot[l] = pivot;
                f.inverse[i][l] = 1.0 / pivot;
                f.deeper[i][l] = below / pivot;
                f.nearer[i][l] = self.link[i][l] / pivot;
            }
        }
    }
}

/// Substitutes back from the surface to the depth, in place.
fn substitute<const L: usize>(nearer: &[[f64; L]], surface: [f64; L], x: &mut [[f64; L]]) {
    let n = x.len();
    let mut carry = surface;
    x[n - 1] = carry;
    for i in (0..n - 1).rev() {
        carry = each(|l| x[i][l] + nearer[i][l] * carry[l]);
        x[i] = carry;
    }
}

/// One value a lane.
fn each<const L: usize>(of: impl FnMut(usize) -> f64) -> [f64; L] {
    std::array::from_fn(of)
}

//! Tridiagonal solver for several slabs at once.
//!
//! Elimination runs from the depth of every slab to its surface; the caller couples the remaining surface equations, one
//! for each slab. The other equations do not depend on the contacts, so they are eliminated once for each length of step.
//! The recurrence from node to node is limited by latency, which slabs that share a SIMD vector (one lane each) share.

use super::Slab;
use crate::tr_bdf2;

/// Equation of a slab's surface cell after elimination of all others: `pivot x = rhs + heat flux into the surface`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceEquation {
    /// Coefficient of the surface cell's increment, W/(m2 K).
    pub pivot: f64,
    /// Right-hand side, W/m2.
    pub rhs: f64,
}

/// Factorisation for one length of step.
#[derive(Clone, Debug)]
struct Factors<const L: usize> {
    step_s: f64,
    /// Whether coefficients have changed since.
    stale: bool,
    storage: Vec<[f64; L]>,
    inverse: Vec<[f64; L]>,
    /// Pivots of the surface cells.
    pivot: [f64; L],
    /// Elimination factors of the neighbours away from and nearer to the surface.
    deeper: Vec<[f64; L]>,
    nearer: Vec<[f64; L]>,
}

/// `L` slabs. Nodes are stored from the depth to the surface; slabs of fewer cells are padded with isolated ones.
#[derive(Clone, Debug)]
pub struct SlabBatch<const L: usize> {
    cells: usize,
    capacity: Vec<[f64; L]>,
    /// Conductance from each node to the next one towards the surface; that of the surface cell is 0.
    link: Vec<[f64; L]>,
    metabolism: Vec<[f64; L]>,
    blood: Vec<[f64; L]>,
    /// Index of each slab's deepest node, conductance through its back, and temperature behind it.
    back: [(usize, f64, f64); L],
    /// Blood flow as a fraction of full flow, and blood temperature, deg C.
    flow: [f64; L],
    blood_c: [f64; L],
    /// Constant power into each node, and its coefficient of the node's temperature.
    source: Vec<[f64; L]>,
    feedback: Vec<[f64; L]>,
    temperature: Vec<[f64; L]>,
    power: Vec<[f64; L]>,
    first: Vec<[f64; L]>,
    second: Vec<[f64; L]>,
    factors: Vec<Factors<L>>,
}

impl<const L: usize> SlabBatch<L> {
    /// Slabs at uniform temperatures, deg C, which their blood shares; `steps_s` are the lengths of step that can be used.
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
            storage: vec![[0.0; L]; cells],
            inverse: vec![[0.0; L]; cells],
            pivot: [0.0; L],
            deeper: vec![[0.0; L]; cells],
            nearer: vec![[0.0; L]; cells],
        });
        let mut batch = Self {
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
        batch.update_sources();
        batch
    }

    /// Sets the blood flow of a slab as a fraction of its full flow.
    pub fn set_flow(&mut self, lane: usize, share: f64) {
        if self.flow[lane] != share {
            self.flow[lane] = share;
            self.update_sources();
        }
    }

    /// Sets the temperature of a slab's blood and behind its back, deg C.
    pub fn set_core_c(&mut self, lane: usize, core_c: f64) {
        self.blood_c[lane] = core_c;
        self.back[lane].2 = core_c;
        self.update_sources();
    }

    /// Recomputes source and feedback of every node.
    fn update_sources(&mut self) {
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
    pub const fn cells(&self) -> usize {
        self.cells
    }

    /// Temperature, deg C, of a node counted from the surface.
    pub fn node_c(&self, lane: usize, node: usize) -> f64 {
        self.temperature[self.cells - 1 - node][lane]
    }

    /// Sets the temperature, deg C, of a node counted from the surface.
    pub fn set_node_c(&mut self, lane: usize, node: usize, temperature_c: f64) {
        self.temperature[self.cells - 1 - node][lane] = temperature_c;
    }

    /// Temperature of the surface cell, deg C.
    pub fn surface_c(&self, lane: usize) -> f64 {
        self.temperature[self.cells - 1][lane]
    }

    /// Mean temperature of a node over the last step, deg C.
    pub fn mean_c(&self, lane: usize, node: usize) -> f64 {
        let i = self.cells - 1 - node;
        tr_bdf2::step_mean(self.temperature[i][lane], self.first[i][lane], self.second[i][lane])
    }

    /// Begins a step, whose length is given by its index, with the heat flux into each surface at its start, W/m2.
    /// Returns the surface equations of the first stage.
    pub fn first_stage(&mut self, step: usize, inflow_w_m2: [f64; L]) -> [SurfaceEquation; L] {
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
            carry =
                each(|l| tr_bdf2::first_stage_rhs(p[l]) * inverse[i][l] + deeper[i][l] * carry[l]);
            first[i] = carry;
        }
        for l in 0..L {
            let extra = inflow_w_m2[l];
            power[n - 1][l] += extra;
            carry[l] += tr_bdf2::first_stage_rhs(extra) * inverse[n - 1][l];
        }
        self.surface_equations(step, carry)
    }

    /// Takes the surface increments of the first stage and returns the surface equations of the second.
    pub fn second_stage(&mut self, step: usize, surface: [f64; L]) -> [SurfaceEquation; L] {
        let n = self.cells;
        let f = &self.factors[step];
        let (storage, inverse) = (&f.storage[..n], &f.inverse[..n]);
        let (deeper, nearer) = (&f.deeper[..n], &f.nearer[..n]);
        let power = &self.power[..n];
        let first = &mut self.first[..n];
        substitute(nearer, surface, first);
        let second = &mut self.second[..n];
        let mut carry = [0.0; L];
        for i in 0..n {
            let rhs: [f64; L] =
                each(|l| tr_bdf2::second_stage_rhs(storage[i][l], first[i][l], power[i][l]));
            carry = each(|l| rhs[l] * inverse[i][l] + deeper[i][l] * carry[l]);
            second[i] = carry;
        }
        self.surface_equations(step, carry)
    }

    /// Ends the step with the surface increments of the second stage.
    pub fn finish_step(&mut self, step: usize, surface: [f64; L]) {
        let n = self.cells;
        let second = &mut self.second[..n];
        substitute(&self.factors[step].nearer[..n], surface, second);
        let (t, first) = (&mut self.temperature[..n], &self.first[..n]);
        for i in 0..n {
            t[i] = each(|l| t[i][l] + (first[i][l] + second[i][l]));
        }
    }

    fn surface_equations(&self, step: usize, solved: [f64; L]) -> [SurfaceEquation; L] {
        let pivot = &self.factors[step].pivot;
        std::array::from_fn(|l| SurfaceEquation { pivot: pivot[l], rhs: solved[l] * pivot[l] })
    }

    /// Factorises for a length of step, unless that is up to date.
    fn factor(&mut self, step: usize) {
        let n = self.cells;
        let f = &mut self.factors[step];
        if !f.stale {
            return;
        }
        f.stale = false;
        for i in 0..n {
            for l in 0..L {
                let storage = tr_bdf2::storage(self.capacity[i][l], f.step_s);
                // All terms are positive, so nothing cancels.
                let mut pivot = storage + self.link[i][l] - self.feedback[i][l];
                let mut below = 0.0;
                if i > 0 {
                    below = self.link[i - 1][l];
                    pivot += below * (1.0 - f.nearer[i - 1][l]);
                }
                f.storage[i][l] = storage;
                f.pivot[l] = pivot;
                f.inverse[i][l] = 1.0 / pivot;
                f.deeper[i][l] = below / pivot;
                f.nearer[i][l] = self.link[i][l] / pivot;
            }
        }
    }
}

/// Back substitution from the surface to the depth, in place.
fn substitute<const L: usize>(nearer: &[[f64; L]], surface: [f64; L], x: &mut [[f64; L]]) {
    let n = x.len();
    let mut carry = surface;
    x[n - 1] = carry;
    for i in (0..n - 1).rev() {
        carry = each(|l| x[i][l] + nearer[i][l] * carry[l]);
        x[i] = carry;
    }
}

/// One value for each slab.
fn each<const L: usize>(of: impl FnMut(usize) -> f64) -> [f64; L] {
    std::array::from_fn(of)
}

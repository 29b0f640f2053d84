//! The tile's nodes and their step in time.
//!
//! ```text
//! zone      0   1 .. Z-1
//! level 0   o - o - o      display face: the finger touches zone 0
//!           |   |   |
//!           :   :   :      levels: face, tab, legs, tab, face
//!           |   |   |
//! last      o - o - o
//!            \  |  /
//!             sink
//! ```
//!
//! The matrix is block tridiagonal with blocks of `Z`. What the current changes is everywhere in it, so it is
//! eliminated in every step.

use crate::scheme;

/// Levels of one tile and zones across it; what is given for a level is per zone.
pub type Across<const Z: usize> = [f64; Z];

/// `Z` zones of `N` levels over one sink.
#[derive(Clone, Debug)]
pub struct Stack<const N: usize, const Z: usize> {
    /// Heat capacities, J/K.
    pub capacity: [Across<Z>; N],
    /// From each level to the next, W/K; the last goes to the sink.
    pub axial: [Across<Z>; N],
    /// From each zone to the next within a level, W/K; the last is open.
    pub lateral: [Across<Z>; N],
    /// Power that does not depend on the node's temperature, W.
    pub source: [Across<Z>; N],
    /// Power in proportion to it, W/K (times deg C).
    pub feedback: [Across<Z>; N],
    /// The sink's.
    pub sink: Sink,

    temperature: [Across<Z>; N],
    power: [Across<Z>; N],
    first: [Across<Z>; N],
    second: [Across<Z>; N],
    /// Inverse of every block after elimination of the levels before it.
    inverse: [[Across<Z>; Z]; N],
    step_s: f64,
}

/// The node that all zones share.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sink {
    /// Heat capacity, J/K.
    pub capacity: f64,
    /// Power that does not depend on its temperature, W.
    pub source: f64,
    /// Power in proportion to it, W/K (times deg C).
    pub feedback: f64,
    temperature: f64,
    power: f64,
    first: f64,
    second: f64,
    inverse: f64,
}

impl<const N: usize, const Z: usize> Stack<N, Z> {
    /// Everything at one temperature, deg C, without links.
    #[must_use]
    pub fn new(temperature_c: f64) -> Self {
        let zero = [[0.0; Z]; N];
        Self {
            capacity: [[1.0; Z]; N],
            axial: zero,
            lateral: zero,
            source: zero,
            feedback: zero,
            sink: Sink {
                capacity: 1.0,
                temperature: temperature_c,
                ..Sink::default()
            },
            temperature: [[temperature_c; Z]; N],
            power: zero,
            first: zero,
            second: zero,
            inverse: [[[0.0; Z]; Z]; N],
            step_s: f64::INFINITY,
        }
    }

    /// Temperature of a node, deg C.
    #[must_use]
    pub fn node_c(&self, level: usize, zone: usize) -> f64 {
        self.temperature[level][zone]
    }

    /// Temperature of the sink, deg C.
    #[must_use]
    pub fn sink_c(&self) -> f64 {
        self.sink.temperature
    }

    /// Where a node will be in the middle of a step of the given length, deg C, if it goes on as in the last one.
    #[must_use]
    pub fn ahead_c(&self, level: usize, zone: usize, step_s: f64) -> f64 {
        let gain = self.first[level][zone] + self.second[level][zone];
        self.temperature[level][zone] + 0.5 * step_s / self.step_s * gain
    }

    /// Mean temperature of a node over the last step, deg C.
    #[must_use]
    pub fn mean_c(&self, level: usize, zone: usize) -> f64 {
        let (i, z) = (level, zone);
        scheme::mean(self.temperature[i][z], self.first[i][z], self.second[i][z])
    }

    /// Mean temperature of the sink over the last step, deg C.
    #[must_use]
    pub fn mean_sink_c(&self) -> f64 {
        scheme::mean(self.sink.temperature, self.sink.first, self.sink.second)
    }

    /// Heat capacity, J/K, and temperature, deg C, of every node.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        let levels = self
            .capacity
            .as_flattened()
            .iter()
            .zip(self.temperature.as_flattened());
        let sink = (self.sink.capacity, self.sink.temperature);
        levels.map(|(capacity, t)| (*capacity, *t)).chain([sink])
    }

    /// First stage of a step: power at the start, with `inflow_w` into the touched node; elimination, with what a
    /// body eliminated before it leaves in that node's row (`pivot_w_k` and `rhs_w`). Gives that node's increment.
    pub fn first(&mut self, step_s: f64, inflow_w: f64, pivot_w_k: f64, rhs_w: f64) -> f64 {
        self.step_s = step_s;
        self.balance(inflow_w);
        self.factor(pivot_w_k);
        for i in 0..N {
            for z in 0..Z {
                self.first[i][z] = scheme::first(self.power[i][z]);
            }
        }
        self.first[0][0] += rhs_w;
        let sink = scheme::first(self.sink.power);
        self.sink.first = solve(
            &self.axial,
            &self.inverse,
            self.sink.inverse,
            &mut self.first,
            sink,
        );
        self.first[0][0]
    }

    /// Second stage, likewise; ends the step.
    pub fn second(&mut self, rhs_w: f64) -> f64 {
        let h = self.step_s;
        for i in 0..N {
            for z in 0..Z {
                let inertia = scheme::inertia(self.capacity[i][z], h);
                self.second[i][z] = scheme::second(inertia, self.first[i][z], self.power[i][z]);
            }
        }
        self.second[0][0] += rhs_w;
        let inertia = scheme::inertia(self.sink.capacity, h);
        let sink = scheme::second(inertia, self.sink.first, self.sink.power);
        self.sink.second = solve(
            &self.axial,
            &self.inverse,
            self.sink.inverse,
            &mut self.second,
            sink,
        );
        for i in 0..N {
            for z in 0..Z {
                self.temperature[i][z] += self.first[i][z] + self.second[i][z];
            }
        }
        self.sink.temperature += self.sink.first + self.sink.second;
        self.second[0][0]
    }

    /// Net power into every node at the present temperatures.
    fn balance(&mut self, inflow_w: f64) {
        let t = &self.temperature;
        self.sink.power = self.sink.source + self.sink.feedback * self.sink.temperature;
        let mut above = [0.0; Z];
        above[0] = inflow_w;
        for i in 0..N {
            for z in 0..Z {
                let next_c = if i + 1 < N {
                    t[i + 1][z]
                } else {
                    self.sink.temperature
                };
                let below = self.axial[i][z] * (t[i][z] - next_c);
                self.power[i][z] =
                    self.source[i][z] + self.feedback[i][z] * t[i][z] + above[z] - below;
                above[z] = below;
            }
            for z in 1..Z {
                let across = self.lateral[i][z - 1] * (t[i][z - 1] - t[i][z]);
                self.power[i][z - 1] -= across;
                self.power[i][z] += across;
            }
        }
        self.sink.power += above.iter().sum::<f64>();
    }

    /// Eliminates level after level; `extra_w_k` belongs to the touched node.
    fn factor(&mut self, extra_w_k: f64) {
        let h = self.step_s;
        let mut block = [[0.0; Z]; Z];
        block[0][0] = extra_w_k;
        for i in 0..N {
            for (z, row) in block.iter_mut().enumerate() {
                row[z] += scheme::inertia(self.capacity[i][z], h) + self.axial[i][z]
                    - self.feedback[i][z];
            }
            for z in 1..Z {
                let across = self.lateral[i][z - 1];
                block[z - 1][z - 1] += across;
                block[z][z] += across;
                block[z - 1][z] -= across;
                block[z][z - 1] -= across;
            }
            let inverse = invert(block);
            self.inverse[i] = inverse;
            // What this level leaves in the next one, or in the sink.
            let link = &self.axial[i];
            for z in 0..Z {
                for y in 0..Z {
                    block[z][y] = -link[z] * inverse[z][y] * link[y];
                }
                // In this order the next level's own link cancels the least.
                block[z][z] += link[z];
            }
        }
        let left: f64 = block.iter().flatten().sum();
        self.sink.inverse =
            1.0 / (scheme::inertia(self.sink.capacity, h) - self.sink.feedback + left);
    }
}

/// Solves for the increments of all nodes in place and gives the sink's; `x` holds the right-hand sides.
fn solve<const N: usize, const Z: usize>(
    axial: &[Across<Z>; N],
    inverse: &[[Across<Z>; Z]; N],
    sink_inverse: f64,
    x: &mut [Across<Z>; N],
    sink: f64,
) -> f64 {
    let mut carry = [0.0; Z];
    for i in 0..N {
        for z in 0..Z {
            carry[z] += x[i][z];
        }
        x[i] = product(&inverse[i], &carry);
        for z in 0..Z {
            carry[z] = axial[i][z] * x[i][z];
        }
    }
    let sink = (sink + carry.iter().sum::<f64>()) * sink_inverse;
    let mut next = [sink; Z];
    for i in (0..N).rev() {
        for z in 0..Z {
            next[z] *= axial[i][z];
        }
        let share = product(&inverse[i], &next);
        for z in 0..Z {
            x[i][z] += share[z];
        }
        next = x[i];
    }
    sink
}

fn product<const Z: usize>(matrix: &[Across<Z>; Z], vector: &Across<Z>) -> Across<Z> {
    std::array::from_fn(|z| (0..Z).map(|y| matrix[z][y] * vector[y]).sum())
}

/// Inverse of a block by Gauss and Jordan. No pivoting: the blocks are diagonally dominant.
fn invert<const Z: usize>(mut block: [Across<Z>; Z]) -> [Across<Z>; Z] {
    for p in 0..Z {
        let inverse = 1.0 / block[p][p];
        block[p][p] = 1.0;
        let pivot = block[p].map(|x| x * inverse);
        block[p] = pivot;
        for (z, row) in block.iter_mut().enumerate() {
            if z != p {
                let factor = row[p];
                row[p] = 0.0;
                for (x, pivot) in row.iter_mut().zip(&pivot) {
                    *x -= factor * pivot;
                }
            }
        }
    }
    block
}

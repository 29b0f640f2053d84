//! Thermal network of the tile and its time step.
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
//! The matrix is block tridiagonal with blocks of `Z` zones. The current changes its coefficients, so it is factorised
//! in every step.

use crate::tr_bdf2;

/// One value for each zone of a level.
pub type PerZone<const Z: usize> = [f64; Z];

/// `Z` zones of `N` levels over one sink.
#[derive(Clone, Debug)]
pub struct ThermalNetwork<const N: usize, const Z: usize> {
    /// Heat capacities, J/K.
    pub capacity: [PerZone<Z>; N],
    /// Conductance from each level to the next, W/K; from the last level to the sink.
    pub axial: [PerZone<Z>; N],
    /// Conductance from each zone to the next within a level, W/K; 0 for the last zone.
    pub lateral: [PerZone<Z>; N],
    /// Power into each node independent of its temperature, W.
    pub source: [PerZone<Z>; N],
    /// Power into the node per degree Celsius of its temperature, W/K.
    pub feedback: [PerZone<Z>; N],
    /// The sink, which all zones share.
    pub sink: SinkNode,

    temperature: [PerZone<Z>; N],
    power: [PerZone<Z>; N],
    first: [PerZone<Z>; N],
    second: [PerZone<Z>; N],
    /// Inverse of each diagonal block after elimination of the levels above it.
    inverse: [[PerZone<Z>; Z]; N],
    step_s: f64,
}

/// The node of the sink.
#[derive(Clone, Copy, Debug, Default)]
pub struct SinkNode {
    /// Heat capacity, J/K.
    pub capacity: f64,
    /// Power into it independent of its temperature, W.
    pub source: f64,
    /// Power into the node per degree Celsius of its temperature, W/K.
    pub feedback: f64,
    temperature: f64,
    power: f64,
    first: f64,
    second: f64,
    inverse: f64,
}

impl<const N: usize, const Z: usize> ThermalNetwork<N, Z> {
    /// All nodes at one temperature, deg C, without conductances.
    #[must_use]
    pub fn new(temperature_c: f64) -> Self {
        let zero = [[0.0; Z]; N];
        Self {
            capacity: [[1.0; Z]; N],
            axial: zero,
            lateral: zero,
            source: zero,
            feedback: zero,
            sink: SinkNode {
                capacity: 1.0,
                temperature: temperature_c,
                ..SinkNode::default()
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

    /// Temperature of a node in the middle of the coming step, extrapolated from the last one, deg C.
    #[must_use]
    pub fn extrapolated_c(&self, level: usize, zone: usize, step_s: f64) -> f64 {
        let increment = self.first[level][zone] + self.second[level][zone];
        self.temperature[level][zone] + 0.5 * step_s / self.step_s * increment
    }

    /// Mean temperature of a node over the last step, deg C.
    #[must_use]
    pub fn mean_c(&self, level: usize, zone: usize) -> f64 {
        let (i, z) = (level, zone);
        tr_bdf2::step_mean(self.temperature[i][z], self.first[i][z], self.second[i][z])
    }

    /// Mean temperature of the sink over the last step, deg C.
    #[must_use]
    pub fn mean_sink_c(&self) -> f64 {
        tr_bdf2::step_mean(self.sink.temperature, self.sink.first, self.sink.second)
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

    /// First stage of a step with a power `inflow_w` from the finger into the patch node at its start. `pivot_w_k` and
    /// `rhs_w` are the contributions of the eliminated finger to the equation of that node. Returns its increment.
    pub fn first_stage(&mut self, step_s: f64, inflow_w: f64, pivot_w_k: f64, rhs_w: f64) -> f64 {
        self.step_s = step_s;
        self.update_power(inflow_w);
        self.factorise(pivot_w_k);
        for i in 0..N {
            for z in 0..Z {
                self.first[i][z] = tr_bdf2::first_stage_rhs(self.power[i][z]);
            }
        }
        self.first[0][0] += rhs_w;
        let sink = tr_bdf2::first_stage_rhs(self.sink.power);
        self.sink.first = solve(
            &self.axial,
            &self.inverse,
            self.sink.inverse,
            &mut self.first,
            sink,
        );
        self.first[0][0]
    }

    /// Second stage, which ends the step, with the finger's contribution to the right-hand side. Returns the increment.
    pub fn second_stage(&mut self, rhs_w: f64) -> f64 {
        let h = self.step_s;
        for i in 0..N {
            for z in 0..Z {
                let storage = tr_bdf2::storage(self.capacity[i][z], h);
                self.second[i][z] =
                    tr_bdf2::second_stage_rhs(storage, self.first[i][z], self.power[i][z]);
            }
        }
        self.second[0][0] += rhs_w;
        let storage = tr_bdf2::storage(self.sink.capacity, h);
        let sink = tr_bdf2::second_stage_rhs(storage, self.sink.first, self.sink.power);
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
    fn update_power(&mut self, inflow_w: f64) {
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

    /// Block elimination from level to level; `extra_w_k` is added to the pivot of the patch node.
    fn factorise(&mut self, extra_w_k: f64) {
        let h = self.step_s;
        let mut block = [[0.0; Z]; Z];
        block[0][0] = extra_w_k;
        for i in 0..N {
            for (z, row) in block.iter_mut().enumerate() {
                row[z] += tr_bdf2::storage(self.capacity[i][z], h) + self.axial[i][z]
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
            // Contribution of this level to the next one, or to the sink.
            let link = &self.axial[i];
            for z in 0..Z {
                for y in 0..Z {
                    block[z][y] = -link[z] * inverse[z][y] * link[y];
                }
                // Adding the link last keeps cancellation smallest.
                block[z][z] += link[z];
            }
        }
        let levels: f64 = block.iter().flatten().sum();
        self.sink.inverse =
            1.0 / (tr_bdf2::storage(self.sink.capacity, h) - self.sink.feedback + levels);
    }
}

/// Solves for the increments of all nodes in place and returns that of the sink; `x` holds the right-hand sides.
fn solve<const N: usize, const Z: usize>(
    axial: &[PerZone<Z>; N],
    inverse: &[[PerZone<Z>; Z]; N],
    sink_inverse: f64,
    x: &mut [PerZone<Z>; N],
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

fn product<const Z: usize>(matrix: &[PerZone<Z>; Z], vector: &PerZone<Z>) -> PerZone<Z> {
    std::array::from_fn(|z| (0..Z).map(|y| matrix[z][y] * vector[y]).sum())
}

/// Gauss-Jordan inverse of a block, without pivoting, since the blocks are diagonally dominant.
fn invert<const Z: usize>(mut block: [PerZone<Z>; Z]) -> [PerZone<Z>; Z] {
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

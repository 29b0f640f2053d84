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
//! The matrix is block tridiagonal with blocks of `Z` zones. The current changes the coefficients of the tabs and legs, so
//! these are factorised in every step. They have no lateral conductance: their levels `FIRST` to `LAST` are `Z` separate
//! columns, each tridiagonal, which are eliminated first. What they leave joins the two plates zone by zone:
//!
//! ```text
//! T x = r + a p + b q        one column between plate nodes p and q, a and b the conductances to them
//! x = T^-1 r + u p + v q     u = T^-1 a, v = T^-1 b
//! into p:  a (x_first - p) = u.r - (a - a u_first) p + a v_first q,   into q likewise
//! ```
//!
//! The levels above the last one of the upper plate have constant coefficients while the contact stays as it is; their
//! elimination is kept from step to step.

use crate::tr_bdf2;

/// One value for each zone of a level.
pub type PerZone<const Z: usize> = [f64; Z];

/// `Z` zones of `N` levels over one sink; levels `FIRST` to `LAST` have no lateral conductance, and one level is below them.
/// All capacities, and all conductances of the levels with an index below `FIRST`, are set before the first step; later changes
/// of these have no effect.
#[derive(Clone, Debug)]
pub struct ThermalNetwork<const N: usize, const Z: usize, const FIRST: usize, const LAST: usize> {
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
    /// Storage term of every node for the length of step.
    storage: [PerZone<Z>; N],
    /// Inverse of each diagonal block of the plates after elimination of the columns and of the levels above it.
    inverse: [[PerZone<Z>; Z]; N],
    columns: Columns<N, Z>,
    upper: UpperPlate<N, Z>,
    step_s: f64,
}

/// Factors of the columns, at the places of their levels.
#[derive(Clone, Debug)]
struct Columns<const N: usize, const Z: usize> {
    /// Inverse of each pivot.
    inverse: [PerZone<Z>; N],
    /// Elimination factor from each level to the next.
    down: [PerZone<Z>; N],
    /// Increments for a unit increment of the node above the column, and of the node below it.
    from_above: [PerZone<Z>; N],
    from_below: [PerZone<Z>; N],
    /// Conductance that the eliminated column leaves between these two nodes.
    across: PerZone<Z>,
}

/// Elimination of the levels of the upper plate that do not touch the columns, and what it was made for.
#[derive(Clone, Debug)]
struct UpperPlate<const N: usize, const Z: usize> {
    step_s: f64,
    extra_w_k: f64,
    feedback: [PerZone<Z>; N],
    /// Contribution to the block of the next level.
    remainder: [PerZone<Z>; Z],
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

impl<const N: usize, const Z: usize, const FIRST: usize, const LAST: usize>
    ThermalNetwork<N, Z, FIRST, LAST>
{
    /// The levels next to the columns.
    const ABOVE: usize = FIRST - 1;
    const BELOW: usize = LAST + 1;

    /// All nodes at one temperature, deg C, without conductances.
    pub fn new(temperature_c: f64) -> Self {
        let zero = [[0.0; Z]; N];
        Self {
            capacity: [[1.0; Z]; N],
            axial: zero,
            lateral: zero,
            source: zero,
            feedback: zero,
            sink: SinkNode { capacity: 1.0, temperature: temperature_c, ..SinkNode::default() },
            temperature: [[temperature_c; Z]; N],
            power: zero,
            first: zero,
            second: zero,
            storage: zero,
            inverse: [[[0.0; Z]; Z]; N],
            columns: Columns {
                inverse: zero,
                down: zero,
                from_above: zero,
                from_below: zero,
                across: [0.0; Z],
            },
            upper: UpperPlate {
                step_s: f64::NAN,
                extra_w_k: 0.0,
                feedback: zero,
                remainder: [[0.0; Z]; Z],
            },
            step_s: f64::INFINITY,
        }
    }

    /// Temperature of a node, deg C.
    pub fn node_c(&self, level: usize, zone: usize) -> f64 {
        self.temperature[level][zone]
    }

    /// Temperature of the sink, deg C.
    pub fn sink_c(&self) -> f64 {
        self.sink.temperature
    }

    /// Temperature of a node in the middle of the coming step, extrapolated from the last one, deg C.
    pub fn extrapolated_c(&self, level: usize, zone: usize, step_s: f64) -> f64 {
        let increment = self.first[level][zone] + self.second[level][zone];
        self.temperature[level][zone] + 0.5 * step_s / self.step_s * increment
    }

    /// Mean temperature of a node over the last step, deg C.
    pub fn mean_c(&self, level: usize, zone: usize) -> f64 {
        let (i, z) = (level, zone);
        tr_bdf2::step_mean(self.temperature[i][z], self.first[i][z], self.second[i][z])
    }

    /// Mean temperature of the sink over the last step, deg C.
    pub fn mean_sink_c(&self) -> f64 {
        tr_bdf2::step_mean(self.sink.temperature, self.sink.first, self.sink.second)
    }

    /// Heat capacity, J/K, and temperature, deg C, of every node.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        let levels = self.capacity.as_flattened().iter().zip(self.temperature.as_flattened());
        let sink = (self.sink.capacity, self.sink.temperature);
        levels.map(|(capacity, t)| (*capacity, *t)).chain([sink])
    }

    /// First stage of a step with a power `inflow_w` from the finger into the patch node at its start. `pivot_w_k` and
    /// `rhs_w` are the contributions of the eliminated finger to the equation of that node. Returns its increment.
    pub fn first_stage(&mut self, step_s: f64, inflow_w: f64, pivot_w_k: f64, rhs_w: f64) -> f64 {
        if self.step_s != step_s {
            self.step_s = step_s;
            for (storage, capacity) in self.storage.iter_mut().zip(&self.capacity) {
                *storage = capacity.map(|capacity| tr_bdf2::storage(capacity, step_s));
            }
        }
        self.update_power(inflow_w);
        self.factorise(pivot_w_k);
        for i in 0..N {
            for z in 0..Z {
                self.first[i][z] = tr_bdf2::first_stage_rhs(self.power[i][z]);
            }
        }
        self.first[0][0] += rhs_w;
        let sink = tr_bdf2::first_stage_rhs(self.sink.power);
        let mut first = self.first;
        self.sink.first = self.solve(&mut first, sink);
        self.first = first;
        self.first[0][0]
    }

    /// Second stage, which ends the step, with the finger's contribution to the right-hand side. Returns the increment.
    pub fn second_stage(&mut self, rhs_w: f64) -> f64 {
        for i in 0..N {
            for z in 0..Z {
                self.second[i][z] = tr_bdf2::second_stage_rhs(
                    self.storage[i][z],
                    self.first[i][z],
                    self.power[i][z],
                );
            }
        }
        self.second[0][0] += rhs_w;
        let storage = tr_bdf2::storage(self.sink.capacity, self.step_s);
        let sink = tr_bdf2::second_stage_rhs(storage, self.sink.first, self.sink.power);
        let mut second = self.second;
        self.sink.second = self.solve(&mut second, sink);
        self.second = second;
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
                let next_c = if i + 1 < N { t[i + 1][z] } else { self.sink.temperature };
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

    /// Eliminates the columns, then the plates from level to level; `extra_w_k` is added to the pivot of the patch node.
    fn factorise(&mut self, extra_w_k: f64) {
        self.factorise_columns();
        if self.upper.step_s != self.step_s
            || self.upper.extra_w_k != extra_w_k
            || self.upper.feedback[..FIRST] != self.feedback[..FIRST]
        {
            self.factorise_upper_plate(extra_w_k);
        }
        let (above, below) = (Self::ABOVE, Self::BELOW);
        let columns = &self.columns;
        // Conductance of the columns into each plate, less what returns through them.
        let mut block = self.upper.remainder;
        for (z, row) in block.iter_mut().enumerate() {
            let link = self.axial[above][z];
            row[z] += link - link * columns.from_above[FIRST][z];
        }
        self.add_level(&mut block, above);
        let inverse = invert(block);
        self.inverse[above] = inverse;

        let across = &columns.across;
        for z in 0..Z {
            for y in 0..Z {
                block[z][y] = -across[z] * inverse[z][y] * across[y];
            }
            let link = self.axial[LAST][z];
            block[z][z] += link - link * columns.from_below[LAST][z] + self.axial[below][z];
        }
        self.add_level(&mut block, below);
        let inverse = invert(block);
        self.inverse[below] = inverse;
        let levels: f64 = eliminated(&inverse, &self.axial[below]).iter().flatten().sum();
        self.sink.inverse =
            1.0 / (tr_bdf2::storage(self.sink.capacity, self.step_s) - self.sink.feedback + levels);
    }

    fn factorise_columns(&mut self) {
        let Columns { inverse, down, from_above, from_below, across } = &mut self.columns;
        let axial = &self.axial;
        let mut carry = axial[Self::ABOVE];
        let mut share = axial[Self::ABOVE];
        for i in FIRST..=LAST {
            for z in 0..Z {
                let link = axial[i][z];
                let pivot = self.storage[i][z] + link - self.feedback[i][z] + carry[z];
                inverse[i][z] = 1.0 / pivot;
                down[i][z] = link * inverse[i][z];
                from_above[i][z] = share[z] * inverse[i][z];
                share[z] *= down[i][z];
                // Adding the link last keeps cancellation smallest.
                carry[z] = link - link * down[i][z];
            }
        }
        from_below[LAST] = down[LAST];
        for i in (FIRST..LAST).rev() {
            for z in 0..Z {
                from_above[i][z] += down[i][z] * from_above[i + 1][z];
                from_below[i][z] = down[i][z] * from_below[i + 1][z];
            }
        }
        for z in 0..Z {
            across[z] = axial[Self::ABOVE][z] * from_below[FIRST][z];
        }
    }

    fn factorise_upper_plate(&mut self, extra_w_k: f64) {
        let mut block = [[0.0; Z]; Z];
        block[0][0] = extra_w_k;
        for i in 0..Self::ABOVE {
            for (z, row) in block.iter_mut().enumerate() {
                row[z] += self.axial[i][z];
            }
            self.add_level(&mut block, i);
            let inverse = invert(block);
            self.inverse[i] = inverse;
            block = eliminated(&inverse, &self.axial[i]);
        }
        self.upper = UpperPlate {
            step_s: self.step_s,
            extra_w_k,
            feedback: self.feedback,
            remainder: block,
        };
    }

    /// Adds what a level has by itself to its block: storage, feedback, and conductance between its zones.
    fn add_level(&self, block: &mut [PerZone<Z>; Z], level: usize) {
        for (z, row) in block.iter_mut().enumerate() {
            row[z] += self.storage[level][z] - self.feedback[level][z];
        }
        for z in 1..Z {
            let across = self.lateral[level][z - 1];
            block[z - 1][z - 1] += across;
            block[z][z] += across;
            block[z - 1][z] -= across;
            block[z][z - 1] -= across;
        }
    }

    /// Solves for the increments of all nodes in place and returns that of the sink; `x` holds the right-hand sides.
    fn solve(&self, x: &mut [PerZone<Z>; N], sink: f64) -> f64 {
        let (above, below) = (Self::ABOVE, Self::BELOW);
        let (axial, columns) = (&self.axial, &self.columns);
        // What the columns give to the plates, and the plates downwards.
        for i in FIRST..=LAST {
            let (up, down) =
                (times(&columns.from_above[i], &x[i]), times(&columns.from_below[i], &x[i]));
            add(&mut x[above], &up);
            add(&mut x[below], &down);
        }
        for i in 0..above {
            x[i] = product(&self.inverse[i], &x[i]);
            let carry = times(&axial[i], &x[i]);
            add(&mut x[i + 1], &carry);
        }
        x[above] = product(&self.inverse[above], &x[above]);
        let carry = times(&columns.across, &x[above]);
        add(&mut x[below], &carry);
        x[below] = product(&self.inverse[below], &x[below]);
        let carry: f64 = (0..Z).map(|z| axial[below][z] * x[below][z]).sum();
        let sink = (sink + carry) * self.sink.inverse;
        // Back from the sink to the surface.
        self.add_share(&mut x[below], below, &axial[below].map(|link| link * sink));
        let next = times(&columns.across, &x[below]);
        self.add_share(&mut x[above], above, &next);
        for i in (0..above).rev() {
            let next = times(&axial[i], &x[i + 1]);
            self.add_share(&mut x[i], i, &next);
        }
        for z in 0..Z {
            x[FIRST][z] += axial[above][z] * x[above][z];
            x[LAST][z] += axial[LAST][z] * x[below][z];
        }
        for i in FIRST..LAST {
            let carry = times(&columns.down[i], &x[i]);
            add(&mut x[i + 1], &carry);
        }
        x[LAST] = times(&x[LAST], &columns.inverse[LAST]);
        for i in (FIRST..LAST).rev() {
            let from_next = times(&columns.down[i], &x[i + 1]);
            x[i] = times(&x[i], &columns.inverse[i]);
            add(&mut x[i], &from_next);
        }
        sink
    }

    /// Adds the increments that a power into the nodes of a level causes.
    fn add_share(&self, x: &mut PerZone<Z>, level: usize, power: &PerZone<Z>) {
        add(x, &product(&self.inverse[level], power));
    }
}

/// Contribution of an eliminated level to the block of the next one, or to the sink.
fn eliminated<const Z: usize>(inverse: &[PerZone<Z>; Z], link: &PerZone<Z>) -> [PerZone<Z>; Z] {
    std::array::from_fn(|z| {
        std::array::from_fn(|y| {
            let through = -link[z] * inverse[z][y] * link[y];
            // Adding the link last keeps cancellation smallest.
            if y == z { through + link[z] } else { through }
        })
    })
}

/// Product zone by zone.
fn times<const Z: usize>(a: &PerZone<Z>, b: &PerZone<Z>) -> PerZone<Z> {
    std::array::from_fn(|z| a[z] * b[z])
}

/// Adds to each zone.
fn add<const Z: usize>(x: &mut PerZone<Z>, share: &PerZone<Z>) {
    for (x, share) in x.iter_mut().zip(share) {
        *x += share;
    }
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

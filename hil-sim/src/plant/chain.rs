//! Heat in a chain of nodes, integrated in time.
//!
//! Node `i` obeys
//!
//! ```text
//! C[i] dT[i]/dt = ahead[i] (T[i+1] - T[i]) + behind[i-1] (T[i-1] - T[i]) + source[i] + feedback[i] T[i]
//! ```
//!
//! A link conducts the same power out of one node and into the other unless the two count in different units: a
//! finger per square metre of contact, say, on a tile counted whole. Hence its two conductances, [`Link`].
//!
//! A step is TR-BDF2 (trapezoidal rule to `2 - sqrt 2` of the step, second-order backward differences to its end):
//! second order, L-stable, and with that fraction both stages share one matrix. The chain is linear and its
//! coefficients are held over a step, so every flow over the step is that of the [mean](Chain::mean_c)
//! temperatures: books kept with them close to rounding.

/// Share of a step that is implicit in each stage, `1 - 1/sqrt 2`; also the last weight of the quadrature.
const IMPLICIT: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// First and second weight of the quadrature that a step amounts to, `sqrt 2 / 4`.
const WEIGHT: f64 = std::f64::consts::FRAC_1_SQRT_2 / 2.0;

/// Conductance between node `i` and node `i + 1`, W/K in the units in which each of them counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Link {
    /// As node `i` feels it.
    pub ahead: f64,
    /// As node `i + 1` feels it.
    pub behind: f64,
}

impl Link {
    /// Nodes that count in the same units.
    #[must_use]
    pub const fn symmetric(conductance_w_k: f64) -> Self {
        Self {
            ahead: conductance_w_k,
            behind: conductance_w_k,
        }
    }

    /// No exchange.
    pub const OPEN: Self = Self::symmetric(0.0);
}

/// A chain of thermal nodes and its temperatures, deg C.
#[derive(Clone, Debug)]
pub struct Chain {
    capacity: Vec<f64>,
    /// `ahead[i]` and `behind[i]` belong to the link from `i` to `i + 1`; the last is open.
    ahead: Vec<f64>,
    behind: Vec<f64>,
    source: Vec<f64>,
    feedback: Vec<f64>,
    temperature: Vec<f64>,

    /// Step for which the rows below `factored` are eliminated.
    step_s: f64,
    factored: usize,
    inertia: Vec<f64>,
    inverse: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,

    power: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Chain {
    /// Nodes of the given heat capacities (J/K, positive) at the given temperatures (deg C), joined by the given
    /// links, one fewer than there are nodes.
    ///
    /// # Panics
    /// If the lengths do not match: a chain is laid out by code, never by input.
    #[must_use]
    pub fn new(capacity_j_k: Vec<f64>, links: &[Link], temperature_c: Vec<f64>) -> Self {
        let n = capacity_j_k.len();
        assert_eq!(temperature_c.len(), n, "a temperature for each node");
        assert_eq!(links.len() + 1, n, "a link between each two neighbours");
        let side = |f: fn(&Link) -> f64| links.iter().map(f).chain([0.0]).collect();
        Self {
            capacity: capacity_j_k,
            ahead: side(|l| l.ahead),
            behind: side(|l| l.behind),
            source: vec![0.0; n],
            feedback: vec![0.0; n],
            temperature: temperature_c,
            step_s: 0.0,
            factored: 0,
            inertia: vec![0.0; n],
            inverse: vec![0.0; n],
            lower: vec![0.0; n],
            upper: vec![0.0; n],
            power: vec![0.0; n],
            first: vec![0.0; n],
            second: vec![0.0; n],
        }
    }

    /// Changes the link from node `i` to node `i + 1`.
    pub fn set_link(&mut self, i: usize, link: Link) {
        if self.link(i) != link {
            self.ahead[i] = link.ahead;
            self.behind[i] = link.behind;
            self.factored = self.factored.min(i);
        }
    }

    /// The link from node `i` to node `i + 1`.
    #[must_use]
    pub fn link(&self, i: usize) -> Link {
        Link {
            ahead: self.ahead[i],
            behind: self.behind[i],
        }
    }

    /// Power into node `i`, W: a part that does not depend on its temperature and a part in proportion to it (W/K
    /// times deg C).
    pub fn set_source(&mut self, i: usize, power_w: f64, feedback_w_k: f64) {
        self.source[i] = power_w;
        if self.feedback[i] != feedback_w_k {
            self.feedback[i] = feedback_w_k;
            self.factored = self.factored.min(i);
        }
    }

    /// Temperature of node `i`, deg C.
    #[must_use]
    pub fn temperature_c(&self, i: usize) -> f64 {
        self.temperature[i]
    }

    /// Mean temperature of node `i` over the last step, deg C, by the step's own quadrature.
    #[must_use]
    pub fn mean_c(&self, i: usize) -> f64 {
        self.temperature[i] - WEIGHT * self.first[i] - (1.0 - IMPLICIT) * self.second[i]
    }

    /// Advances by one step, s. Rows that did not change since the last step of this length are not eliminated
    /// again, so what changes often belongs at the end of the chain.
    pub fn step(&mut self, step_s: f64) {
        self.factor(step_s);
        self.balance();
        let n = self.power.len();
        let (power, inertia) = (&self.power[..n], &self.inertia[..n]);

        // In increments: the first stage gains twice the power at the start, less what the gain itself costs.
        let first = &mut self.first[..n];
        for (x, p) in first.iter_mut().zip(power) {
            *x = 2.0 * p;
        }
        solve(&self.inverse, &self.lower, &self.upper, first);
        // The power at the first stage is `inertia * first - power`: it needs no evaluation of its own.
        let second = &mut self.second[..n];
        for i in 0..n {
            second[i] = WEIGHT / IMPLICIT * inertia[i] * first[i] - power[i];
        }
        solve(&self.inverse, &self.lower, &self.upper, second);
        for ((t, a), b) in self.temperature.iter_mut().zip(first).zip(second) {
            *t += *a + *b;
        }
    }

    /// Net power into every node at the present temperatures, W.
    fn balance(&mut self) {
        let n = self.power.len();
        let (t, ahead, behind) = (&self.temperature[..n], &self.ahead[..n], &self.behind[..n]);
        let (source, feedback) = (&self.source[..n], &self.feedback[..n]);
        let power = &mut self.power[..n];
        for i in 0..n {
            power[i] = source[i] + feedback[i] * t[i];
        }
        for i in 1..n {
            let rise = t[i] - t[i - 1];
            power[i - 1] += ahead[i - 1] * rise;
            power[i] -= behind[i - 1] * rise;
        }
    }

    /// Eliminates `C/(IMPLICIT h) - J` from the first changed row on.
    fn factor(&mut self, step_s: f64) {
        if self.step_s != step_s {
            self.step_s = step_s;
            self.factored = 0;
            for (m, c) in self.inertia.iter_mut().zip(&self.capacity) {
                *m = c / (IMPLICIT * step_s);
            }
        }
        for i in self.factored..self.capacity.len() {
            // Sums of positive terms, apart from the feedback: nothing cancels.
            let mut pivot = self.inertia[i] + self.ahead[i] - self.feedback[i];
            let mut behind = 0.0;
            if i > 0 {
                behind = self.behind[i - 1];
                pivot += behind * (1.0 - self.upper[i - 1]);
            }
            self.inverse[i] = 1.0 / pivot;
            self.lower[i] = behind / pivot;
            self.upper[i] = self.ahead[i] / pivot;
        }
        self.factored = self.capacity.len();
    }
}

/// Solves for the increments in place; `x` holds the right-hand side.
fn solve(inverse: &[f64], lower: &[f64], upper: &[f64], x: &mut [f64]) {
    let n = x.len();
    let (inverse, lower, upper) = (&inverse[..n], &lower[..n], &upper[..n]);
    let mut carry = 0.0;
    for i in 0..n {
        carry = x[i] * inverse[i] + lower[i] * carry;
        x[i] = carry;
    }
    carry = 0.0;
    for i in (0..n).rev() {
        carry = x[i] + upper[i] * carry;
        x[i] = carry;
    }
}

#[cfg(test)]
mod tests;

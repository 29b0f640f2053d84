//! A first-order lag, and a dead time.

use crate::STEP_S;

/// A lag and its decay over the step it was last used with.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    lag_s: f64,
    step_s: f64,
    decay: f64,
    /// The lag in such steps.
    steps: f64,
}

impl Lag {
    /// A lag, s, above 0.
    pub const fn new(lag_s: f64) -> Self {
        Self {
            lag_s,
            step_s: 0.0,
            decay: 1.0,
            steps: 0.0,
        }
    }

    fn set_step(&mut self, step_s: f64) {
        if self.step_s != step_s {
            self.step_s = step_s;
            self.decay = (-step_s / self.lag_s).exp();
            self.steps = self.lag_s / step_s;
        }
    }

    /// Where it is after a step, s, over which its target has moved evenly. Exact: on a ramp it trails by its own
    /// time.
    pub fn along_ramp(&mut self, step_s: f64, at: f64, from: f64, to: f64) -> f64 {
        self.set_step(step_s);
        let trail = self.steps * (to - from);
        to - trail + (at - from + trail) * self.decay
    }

    /// Where it is after a step, s, over which its target has stood still. Exact.
    pub fn towards(&mut self, step_s: f64, at: f64, target: f64) -> f64 {
        self.set_step(step_s);
        target + (at - target) * self.decay
    }
}

/// Steps that a dead time can last.
const LONGEST: usize = 50;

/// A dead time of whole steps of the plant.
#[derive(Clone, Copy, Debug)]
pub struct Delay {
    /// What is under way, in a ring, of which the first `steps` places are used.
    past: [f64; LONGEST],
    steps: usize,
    next: usize,
}

impl Delay {
    /// The longest, s.
    pub const LONGEST_S: f64 = LONGEST as f64 * STEP_S;

    /// A dead time, s, to the nearest step, in which nothing but `at` is under way.
    pub const fn new(delay_s: f64, at: f64) -> Self {
        let steps = (delay_s / STEP_S + 0.5) as usize;
        Self {
            past: [at; LONGEST],
            steps: if steps < LONGEST { steps } else { LONGEST },
            next: 0,
        }
    }

    /// What arrives in a step in which `value` sets out.
    pub fn push(&mut self, value: f64) -> f64 {
        if self.steps == 0 {
            return value;
        }
        let arrived = std::mem::replace(&mut self.past[self.next], value);
        self.next = (self.next + 1) % self.steps;
        arrived
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_time_is_whole_steps() {
        for (delay_s, steps) in [
            (0.0, 0),
            (0.4e-3, 0),
            (1e-3, 1),
            (8e-3, 8),
            (Delay::LONGEST_S, LONGEST),
        ] {
            let mut delay = Delay::new(delay_s, -1.0);
            for value in 0..200 {
                let expected = if value < steps {
                    -1.0
                } else {
                    (value - steps) as f64
                };
                assert_eq!(delay.push(value as f64), expected, "{delay_s} s");
            }
        }
    }
}

//! A first-order lag.

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

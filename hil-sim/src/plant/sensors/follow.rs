//! A first-order lag.

/// A lag and its decay over the step it was last used with.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    lag_s: f64,
    step_s: f64,
    decay: f64,
}

impl Lag {
    /// A lag, s, above 0.
    pub const fn new(lag_s: f64) -> Self {
        Self {
            lag_s,
            step_s: 0.0,
            decay: 1.0,
        }
    }

    /// Part of a distance that is left after a step, s.
    fn decay(&mut self, step_s: f64) -> f64 {
        if self.step_s != step_s {
            self.step_s = step_s;
            self.decay = (-step_s / self.lag_s).exp();
        }
        self.decay
    }

    /// Where it is after a step, s, over which its target has moved evenly. Exact: on a ramp it trails by its own
    /// time.
    pub fn along_ramp(&mut self, step_s: f64, at: f64, from: f64, to: f64) -> f64 {
        let trail = self.lag_s * (to - from) / step_s;
        to - trail + (at - from + trail) * self.decay(step_s)
    }

    /// Where it is after a step, s, over which its target has stood still. Exact.
    pub fn towards(&mut self, step_s: f64, at: f64, target: f64) -> f64 {
        target + (at - target) * self.decay(step_s)
    }
}

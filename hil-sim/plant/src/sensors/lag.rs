//! First-order lag and dead time.

use crate::STEP_S;

/// First-order lag, integrated exactly; the decay is cached for the last length of step.
#[derive(Clone, Copy, Debug)]
pub struct FirstOrderLag {
    time_constant_s: f64,
    step_s: f64,
    decay: f64,
    /// Time constant in steps.
    steps: f64,
}

impl FirstOrderLag {
    /// A lag with a time constant, s, above 0.
    pub const fn new(time_constant_s: f64) -> Self {
        Self { time_constant_s, step_s: 0.0, decay: 1.0, steps: 0.0 }
    }

    fn set_step(&mut self, step_s: f64) {
        if self.step_s != step_s {
            self.step_s = step_s;
            self.decay = (-step_s / self.time_constant_s).exp();
            self.steps = self.time_constant_s / step_s;
        }
    }

    /// Output after a step, s, in which the input moves linearly between two values.
    pub fn ramp_response(&mut self, step_s: f64, output: f64, from: f64, to: f64) -> f64 {
        self.set_step(step_s);
        let trail = self.steps * (to - from);
        to - trail + (output - from + trail) * self.decay
    }

    /// Output after a step, s, with a constant input.
    pub fn step_response(&mut self, step_s: f64, output: f64, input: f64) -> f64 {
        self.set_step(step_s);
        input + (output - input) * self.decay
    }
}

/// Largest dead time in steps of the plant.
const MAX_STEPS: usize = 50;

/// Dead time of a whole number of plant steps.
#[derive(Clone, Copy, Debug)]
pub struct Delay {
    /// Ring buffer of the delayed values, of which the first `steps` places are used.
    past: [f64; MAX_STEPS],
    steps: usize,
    next: usize,
}

impl Delay {
    /// Largest dead time, s.
    pub const MAX_S: f64 = MAX_STEPS as f64 * STEP_S;

    /// A dead time, s, rounded to steps, whose input was `initial` until now.
    pub const fn new(delay_s: f64, initial: f64) -> Self {
        let steps = (delay_s / STEP_S + 0.5) as usize;
        Self {
            past: [initial; MAX_STEPS],
            steps: if steps < MAX_STEPS { steps } else { MAX_STEPS },
            next: 0,
        }
    }

    /// Takes the input of a step and returns its output.
    pub fn push(&mut self, value: f64) -> f64 {
        if self.steps == 0 {
            return value;
        }
        let output = std::mem::replace(&mut self.past[self.next], value);
        self.next = (self.next + 1) % self.steps;
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_time_delays_by_whole_steps() {
        for (delay_s, steps) in
            [(0.0, 0), (0.4e-3, 0), (1e-3, 1), (8e-3, 8), (Delay::MAX_S, MAX_STEPS)]
        {
            let mut delay = Delay::new(delay_s, -1.0);
            for value in 0..200 {
                let expected = if value < steps { -1.0 } else { (value - steps) as f64 };
                assert_eq!(delay.push(value as f64), expected, "{delay_s} s");
            }
        }
    }
}

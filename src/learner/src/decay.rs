//! First-order decay within a window, in `f64`, for constants and set-up.

use crate::window::WINDOW_S;

/// How a first-order lag answers an input that is constant within a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowDecay {
    /// Part of the state that remains at the window's end, `e^-x` with `x` the rate times the window.
    pub remaining: f64,
    /// Mean of the decaying state over the window, over its value at the start: `(1 - e^-x) / x`.
    pub mean: f64,
    /// Mean, over the window, of the response to an input that is constant in it and has the integral 1: `(1 - mean) / x`.
    pub mean_of_input_response: f64,
}

/// Terms of the series, which for `x` up to a half are exact to the resolution of `f64`.
const TERMS: i32 = 16;

impl WindowDecay {
    /// For a rate, 1/s, from 0 to 1e5.
    pub const fn new(rate_1_s: f64) -> Self {
        let x = rate_1_s * WINDOW_S;
        let (mut part, mut halvings) = (x, 0);
        while part > 0.5 {
            part /= 2.0;
            halvings += 1;
        }
        // (x - 1 + e^-x) / x^2 as a series, because the difference would lose digits at small x.
        let (mut term, mut sum) = (0.5, 0.0);
        let mut k = 0;
        while k < TERMS {
            sum += term;
            term *= -part / (k + 3) as f64;
            k += 1;
        }
        if halvings == 0 {
            let mean = 1.0 - x * sum;
            return Self { remaining: 1.0 - x * mean, mean, mean_of_input_response: sum };
        }
        let mut remaining = 1.0 - part * (1.0 - part * sum);
        while halvings > 0 {
            remaining *= remaining;
            halvings -= 1;
        }
        let mean = (1.0 - remaining) / x;
        Self { remaining, mean, mean_of_input_response: (1.0 - mean) / x }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decays_are_those_of_the_exponential() {
        for tenths in -80..=50 {
            let rate_1_s = 10f64.powf(f64::from(tenths) / 10.0);
            let (decay, x) = (WindowDecay::new(rate_1_s), rate_1_s * WINDOW_S);
            let mean = -(-x).exp_m1() / x;
            let close = |a: f64, b: f64| (a - b).abs() < 1e-13;
            assert!(close(decay.remaining, (-x).exp()), "{rate_1_s}: {decay:?}");
            assert!(close(decay.mean, mean), "{rate_1_s}: {decay:?}");
            // The closed form loses digits at small x.
            let series = 0.5 - x / 6.0 + x * x / 24.0;
            let (expected, error) =
                if x < 1e-4 { (series, 1e-12) } else { ((1.0 - mean) / x, 1e-10) };
            assert!(
                (decay.mean_of_input_response - expected).abs() < error,
                "{rate_1_s}: {decay:?}"
            );
        }
    }
}

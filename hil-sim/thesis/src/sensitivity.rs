//! Sensitivity `d'` of an m-alternative forced choice (section 3.3.2), and of the choice of the different one of three.

use contact_model::reference::Real;

use super::bisection::bisect;
use super::statistics::{normal, normal_density};

/// Largest magnitude of the sensitivity; beyond it the proportion correct is 0 or 1 to 1e-15.
const LARGEST: f64 = 12.0;

/// `d'` from the proportion of correct answers with a number of alternatives (3AFC: 3). The target is drawn from a normal
/// density shifted by `d'`, the other alternatives from one at 0, and the largest draw is chosen:
/// `p = integral phi(x - d') Phi(x)^(m - 1) dx`. Error below 1e-12 for `p` from 0.01 to 0.99.
#[must_use]
pub fn d_prime(alternatives: u32, proportion: f64) -> f64 {
    bisect(
        |d| proportion_correct(alternatives, d),
        proportion,
        -LARGEST,
        LARGEST,
    )
}

/// Proportion correct at `d`. The trapezoidal rule converges exponentially for this smooth integrand.
fn proportion_correct(alternatives: u32, d: f64) -> f64 {
    const STEP: f64 = 1.0 / 16.0;
    const STEPS: i32 = 9 * 16;
    let others = f64::from(alternatives - 1);
    let sum: f64 = (-STEPS..=STEPS)
        .map(|i| {
            let x = f64::from(i) * STEP;
            let smaller = 0.5 * Real::erfc(-(x + d) / std::f64::consts::SQRT_2);
            (-0.5 * x * x).exp() * smaller.powf(others)
        })
        .sum();
    sum * STEP / std::f64::consts::TAU.sqrt()
}

/// `d'` from the proportion of correct answers where the different one of three is to be found, and the direction of its
/// difference is not known (triangular method): the draw farthest from the other two is chosen.
#[must_use]
pub fn d_prime_oddity(proportion: f64) -> f64 {
    bisect(proportion_odd, proportion, 0.0, LARGEST)
}

/// `p = 2 integral from 0 phi(u) (Phi(-u sqrt 3 + d sqrt(2/3)) + Phi(-u sqrt 3 - d sqrt(2/3))) du`.
fn proportion_odd(d: f64) -> f64 {
    const STEP: f64 = 1.0 / 256.0;
    const STEPS: i32 = 9 * 256;
    let shift = d * (2.0f64 / 3.0).sqrt();
    let sum: f64 = (0..STEPS)
        .map(|i| {
            // The midpoint rule, as the integrand does not vanish at zero.
            let u = (f64::from(i) + 0.5) * STEP;
            let near = u * 3f64.sqrt();
            normal_density(u) * (normal(shift - near) + normal(-shift - near))
        })
        .sum();
    2.0 * sum * STEP
}

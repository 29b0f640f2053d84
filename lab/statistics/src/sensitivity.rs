//! Sensitivity `d'` of forced choices (signal detection theory), from a proportion of correct answers and back: choice of the
//! largest of m, and choice of the different one of three (oddity, triangular method).

use crate::Result;
use crate::distribution::{normal_cdf, normal_density};
use crate::error::checked;
use crate::search::bisect;

/// Largest magnitude of the sensitivity; beyond it the proportion correct is 0 or 1 to 1e-15.
const LARGEST: f64 = 12.0;

/// `d'` from the proportion of correct answers with a number of alternatives (3AFC: 3). The target is drawn from a normal
/// density shifted by `d'`, the other alternatives from one at 0, and the largest draw is chosen:
/// `p = integral phi(x - d') Phi(x)^(m - 1) dx`. With two alternatives this is `sqrt(2) z(p)`. Negative below chance; -12 and
/// 12 for 0 and 1, which [`log_linear`](crate::proportion::Proportion::log_linear) avoids. Error below 1e-12 for `p` from 0.01
/// to 0.99.
///
/// # Errors
/// Fewer than 2 or more than 100 alternatives, or a proportion that is not from 0 to 1.
pub fn d_prime(alternatives: u32, proportion: f64) -> Result<f64> {
    check_alternatives(alternatives)?;
    Ok(bisect(|d| correct(alternatives, d), check_proportion(proportion)?, -LARGEST, LARGEST))
}

/// Proportion correct at `d'` with a number of alternatives, from 0 to 1. Error below 1e-14.
///
/// # Errors
/// Fewer than 2 or more than 100 alternatives, or a `d'` that is not from -12 to 12.
pub fn proportion_correct(alternatives: u32, d_prime: f64) -> Result<f64> {
    check_alternatives(alternatives)?;
    Ok(correct(alternatives, check_d_prime(d_prime)?))
}

/// `d'` from the proportion of correct answers where the different one of three is to be found, and the direction of its
/// difference is not known (triangular method): the draw farthest from the other two is chosen. 0 at chance (1/3) and below,
/// 12 for 1.
///
/// # Errors
/// A proportion that is not from 0 to 1.
pub fn d_prime_oddity(proportion: f64) -> Result<f64> {
    let proportion = check_proportion(proportion)?;
    // At chance the curve is level, and rounding would decide.
    if proportion <= correct_oddity(0.0) {
        return Ok(0.0);
    }
    Ok(bisect(correct_oddity, proportion, 0.0, LARGEST))
}

/// Proportion correct at `d'` where the different one of three is to be found:
/// `p = 2 integral from 0 phi(u) (Phi(-u sqrt 3 + d sqrt(2/3)) + Phi(-u sqrt 3 - d sqrt(2/3))) du`. Error below 1e-14.
///
/// # Errors
/// A `d'` that is not from -12 to 12; the sign does not matter.
pub fn proportion_correct_oddity(d_prime: f64) -> Result<f64> {
    Ok(correct_oddity(check_d_prime(d_prime)?))
}

/// The trapezoidal rule converges exponentially for this smooth integrand.
fn correct(alternatives: u32, d: f64) -> f64 {
    const STEP: f64 = 1.0 / 16.0;
    const STEPS: i32 = 9 * 16;
    let others = f64::from(alternatives - 1);
    let sum: f64 = (-STEPS..=STEPS)
        .map(|i| {
            let x = f64::from(i) * STEP;
            normal_density(x) * normal_cdf(x + d).powf(others)
        })
        .sum();
    sum * STEP
}

/// The integrand does not vanish at zero. In x, with `u = exp(x - exp(-x))`, it vanishes at both ends together with all its
/// derivatives, and the trapezoidal rule converges exponentially.
fn correct_oddity(d: f64) -> f64 {
    const STEP: f64 = 1.0 / 32.0;
    /// From x = -4, where u is 4e-26, to 2.5, where it is 11.2.
    const STEPS: std::ops::RangeInclusive<i32> = -4 * 32..=80;
    let shift = d * (2.0f64 / 3.0).sqrt();
    let sum: f64 = STEPS
        .map(|i| {
            let x = f64::from(i) * STEP;
            let u = (x - (-x).exp()).exp();
            let du = u * (1.0 + (-x).exp());
            let near = u * 3f64.sqrt();
            du * normal_density(u) * (normal_cdf(shift - near) + normal_cdf(-shift - near))
        })
        .sum();
    2.0 * sum * STEP
}

fn check_alternatives(alternatives: u32) -> Result<()> {
    let allowed = |_| (2..=100).contains(&alternatives);
    checked("alternatives", f64::from(alternatives), "from 2 to 100", allowed).map(|_| ())
}

fn check_proportion(proportion: f64) -> Result<f64> {
    checked("proportion", proportion, "from 0 to 1", |p| (0.0..=1.0).contains(&p))
}

fn check_d_prime(d_prime: f64) -> Result<f64> {
    checked("d'", d_prime, "from -12 to 12", |d| d.abs() <= LARGEST)
}

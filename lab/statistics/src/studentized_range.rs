//! Distribution of the studentized range (Tukey): the range of normal means, over their standard error that was estimated
//! independently.

use crate::Result;
use crate::distribution::{degrees, normal_cdf, normal_density};
use crate::error::{checked, inner_probability};
use crate::search::bisect;

/// Most means: the rule of the inner integral is exact to 1e-15 up to this number.
const MEANS_MAX: u32 = 50;

/// Probability that the range of `means` means exceeds `q` standard errors, from 0 to 1; the standard error has `df` degrees of
/// freedom. Both integrals are sums of positive terms, so that small probabilities keep their digits.
///
/// # Errors
/// `q` is negative or no number, fewer than 2 or more than 50 means, or degrees of freedom that are below 1 or
/// above 1e5.
pub fn studentized_range_tail(q: f64, means: u32, df: f64) -> Result<f64> {
    let q = checked("q", q, "0 or more", |q| q >= 0.0)?;
    checked("number of means", f64::from(means), "from 2 to 50", |_| {
        (2..=MEANS_MAX).contains(&means)
    })?;
    // With fewer than 1 the density has no end.
    let df = checked("degrees of freedom", degrees(df)?, "1 or more", |df| df >= 1.0)?;
    if q == 0.0 || q.is_infinite() {
        return Ok(if q == 0.0 { 1.0 } else { 0.0 });
    }
    // Over x = ln s, where s is the estimated over the true standard error: the density of x is proportional to
    // exp(df (x - e^2x / 2)), an analytic function that vanishes at both ends, for which the trapezoidal rule converges
    // exponentially. Its peak is at 0, its width about 1 / sqrt(2 df).
    let step = (0.25 / df.sqrt()).min(0.05);
    let log_density = |x: f64| df * (x - 0.5 * ((2.0 * x).exp() - 1.0));
    let (mut weights, mut tail) = (0.0, 0.0);
    let mut add = |x: f64| {
        let weight = log_density(x).exp();
        weights += weight;
        tail += weight * range_tail(q * x.exp(), means);
        // Beyond, the density is below the rounding of probabilities of 1e-12.
        log_density(x) > -70.0
    };
    let _ = add(0.0);
    for direction in [-step, step] {
        let mut i = 1.0;
        while add(direction * i) {
            i += 1.0;
        }
    }
    Ok(tail / weights)
}

/// `q` that the studentized range exceeds with a probability.
///
/// # Errors
/// A probability that is not between 0 and 1, or the errors of [`studentized_range_tail`].
pub fn studentized_range_quantile(probability: f64, means: u32, df: f64) -> Result<f64> {
    /// Above the quantile of 1e-5 with one degree of freedom.
    const Q_MAX: f64 = 1e7;
    let probability = inner_probability("probability", probability)?;
    studentized_range_tail(1.0, means, df)?;
    let falling = |q: f64| -studentized_range_tail(q, means, df).unwrap_or(0.0);
    Ok(bisect(falling, -probability, 0.0, Q_MAX))
}

/// Probability that the range of normal variables with deviation 1 exceeds `width`:
/// `k integral phi(z) (Phi(z)^(k-1) - (Phi(z) - Phi(z - width))^(k-1)) dz`, where `z` is the largest.
fn range_tail(width: f64, means: u32) -> f64 {
    /// With it the trapezoidal rule's error is below 1e-15 for 50 means.
    const STEP: f64 = 1.0 / 8.0;
    /// Beyond it the normal density is below 1e-22.
    const END: f64 = 10.0;
    let others = f64::from(means - 1);
    // The largest of a wide range is about half of it, where the density of both ends is greatest.
    let high = END.max(0.5 * width + END);
    // Phi(-38) is the smallest that is not zero.
    if 0.5 * width > 38.0 {
        return 0.0;
    }
    let steps = ((high + END) / STEP).ceil() as u32;
    let sum: f64 = (0..=steps)
        .map(|i| {
            let z = -END + STEP * f64::from(i);
            let below = normal_cdf(z);
            let outside = (normal_cdf(z - width) / below).min(1.0);
            normal_density(z) * below.powf(others) * -(others * (-outside).ln_1p()).exp_m1()
        })
        .sum();
    f64::from(means) * sum * STEP
}

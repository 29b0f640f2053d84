//! Probabilities and quantiles of the distributions of test statistics. Degrees of freedom need not be whole numbers, because
//! those of Greenhouse and Geisser are none.
//!
//! They rest on the regularised incomplete beta and gamma functions of the crate `statrs`, and on the error function of `libm`,
//! because that of `statrs` 0.19.1 is wrong by up to 1e-10. What is computed here is the argument: the complement of a number
//! close to one would lose the digits of a small probability.

use statrs::function::beta::beta_reg;
use statrs::function::erf::erfc_inv;
use statrs::function::gamma::gamma_ur;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI, SQRT_2, TAU};

use crate::Result;
use crate::error::{checked, inner_probability};
use crate::search::bisect;

/// Cumulative normal distribution. Error below 1e-14 relative for `z` of -30 or more.
pub fn normal_cdf(z: f64) -> f64 {
    /// What the double nearest to `1 / sqrt 2` leaves of it.
    const REST: f64 = -4.833646656726457e-17;
    /// Here the probability differs from 0 and 1 by less than an `f64` can show.
    const FARTHEST: f64 = 40.0;
    let z = z.clamp(-FARTHEST, FARTHEST);
    let x = -z * FRAC_1_SQRT_2;
    // The rounding of `x`, which far from the middle changes the probability by 2 x times as much: by 1e-13 at -30.
    let rounded_off = (-z).mul_add(FRAC_1_SQRT_2, -x) - z * REST;
    let slope = FRAC_2_SQRT_PI * (-x * x).exp();
    0.5 * (libm::erfc(x) - slope * rounded_off)
}

/// Density of the normal distribution.
pub fn normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / TAU.sqrt()
}

/// `z` below which a normal variable is with a probability.
///
/// # Errors
/// A probability that is not between 0 and 1.
pub fn normal_quantile(probability: f64) -> Result<f64> {
    let p = inner_probability("probability", probability)?;
    // A step of Newton's method on a start that is right to 1e-9.
    let z = -SQRT_2 * erfc_inv(2.0 * p);
    Ok(z - (normal_cdf(z) - p) / normal_density(z))
}

/// Probability of `f` or more with degrees of freedom of effect and error, from 0 to 1: the incomplete beta function
/// `I(error / (error + effect f); error / 2, effect / 2)`.
///
/// # Errors
/// `f` is negative or no number, or degrees of freedom are not above 0 and up to 1e5.
pub fn f_tail(f: f64, effect_df: f64, error_df: f64) -> Result<f64> {
    let f = not_negative("F", f)?;
    let effect_df = degrees(effect_df)?;
    let error_df = degrees(error_df)?;
    let explained = effect_df * f;
    if explained.is_infinite() {
        return Ok(0.0);
    }
    let total = explained + error_df;
    let (a, b) = (0.5 * error_df, 0.5 * effect_df);
    let unexplained = error_df / total;
    // `statrs` sums the fraction of whichever argument is below its mean, and takes the complement where that is the other one:
    // here with all digits of the other argument.
    Ok(if unexplained < (a + 1.0) / (a + b + 2.0) {
        beta_reg(a, b, unexplained)
    } else {
        1.0 - beta_reg(b, a, explained / total)
    })
}

/// Probability of `t` or more of either sign, from 0 to 1.
///
/// # Errors
/// `t` is no number, or degrees of freedom are not above 0 and up to 1e5.
pub fn t_tail(t: f64, df: f64) -> Result<f64> {
    f_tail(checked("t", t, "a number", |t| !t.is_nan())?.powi(2), 1.0, df)
}

/// `t` that is exceeded, with either sign, with a probability.
///
/// # Errors
/// A probability that is not between 0 and 1, or degrees of freedom that are not above 0 and up to 1e5.
pub fn t_quantile(probability: f64, df: f64) -> Result<f64> {
    let probability = inner_probability("probability", probability)?;
    let df = degrees(df)?;
    let tail = |t: f64| t_tail(t, df).unwrap_or(0.0);
    let mut high = 1.0;
    while tail(high) > probability {
        high *= 2.0;
    }
    Ok(bisect(|t| -tail(t), -probability, 0.0, high))
}

/// Probability of a correlation of `r` or more of either sign between `pairs` uncorrelated pairs: that of
/// `t = r sqrt((n - 2) / (1 - r²))`.
///
/// # Errors
/// `r` is not from -1 to 1, or there are fewer than three pairs.
pub fn correlation_tail(r: f64, pairs: usize) -> Result<f64> {
    let r = checked("r", r, "from -1 to 1", |r| (-1.0..=1.0).contains(&r))?;
    crate::error::at_least("pairs", pairs, 3)?;
    let df = (pairs - 2) as f64;
    f_tail(r * r * df / ((1.0 - r) * (1.0 + r)), 1.0, df)
}

/// Probability of `chi²` or more, from 0 to 1: the incomplete gamma function.
///
/// # Errors
/// `chi²` is negative or no number, or degrees of freedom are not above 0 and up to 1e5.
pub fn chi_square_tail(chi_square: f64, df: f64) -> Result<f64> {
    let chi_square = not_negative("chi²", chi_square)?;
    let df = degrees(df)?;
    Ok(match chi_square {
        0.0 => 1.0,
        f64::INFINITY => 0.0,
        _ => gamma_ur(0.5 * df, 0.5 * chi_square),
    })
}

/// Probability of at least `least` correct of `total` answers, each of which is correct with the probability `chance`:
/// `sum over k from least of C(n, k) c^k (1 - c)^(n - k)`, which is the incomplete beta function `I(c; least, n - least + 1)`.
///
/// # Errors
/// A chance that is not from 0 to 1.
pub fn binomial_tail(total: u32, least: u32, chance: f64) -> Result<f64> {
    let chance = checked("chance", chance, "from 0 to 1", |c| (0.0..=1.0).contains(&c))?;
    Ok(if least == 0 {
        1.0
    } else if least > total {
        0.0
    } else {
        beta_reg(f64::from(least), f64::from(total - least) + 1.0, chance)
    })
}

fn not_negative(what: &'static str, value: f64) -> Result<f64> {
    checked(what, value, "0 or more", |value| value >= 0.0)
}

pub(crate) fn degrees(df: f64) -> Result<f64> {
    // The fraction of the incomplete beta function is cut after 140 terms, which do not suffice far above.
    checked("degrees of freedom", df, "above 0, up to 1e5", |df| df > 0.0 && df <= 1e5)
}

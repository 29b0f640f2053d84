//! Probabilities of the statistics that the thesis reports, by the trapezoidal rule.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, TAU};

use contact_model::reference::Real;

/// Integral of a function by the trapezoidal rule.
fn integral((low, high): (f64, f64), steps: u32, function: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / f64::from(steps);
    let inner: f64 = (1..steps)
        .map(|i| function(low + step * f64::from(i)))
        .sum();
    step * (0.5 * (function(low) + function(high)) + inner)
}

/// Cumulative normal distribution.
pub(super) fn normal(z: f64) -> f64 {
    0.5 * Real::erfc(-z * FRAC_1_SQRT_2)
}

/// Density of the normal distribution.
pub(super) fn normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / TAU.sqrt()
}

/// Probability of `f` or more with degrees of freedom of effect and error: an incomplete beta function, in the angle whose
/// squared sine is its argument. Error below 1e-6.
pub(super) fn f_tail(f: f64, of_effect: f64, of_error: f64) -> f64 {
    let density = |angle: f64| angle.sin().powf(of_error - 1.0) * angle.cos().powf(of_effect - 1.0);
    let limit = (of_error / (of_error + of_effect * f)).sqrt().asin();
    let below = |limit| integral((0.0, limit), 4000, density);
    below(limit) / below(FRAC_PI_2)
}

/// Probability of `t` or more, of either sign.
pub(super) fn t_tail(t: f64, of_error: f64) -> f64 {
    f_tail(t * t, 1.0, of_error)
}

/// Probability of a correlation of `r` or more, of either sign, between `n` uncorrelated pairs.
pub(super) fn r_tail(r: f64, n: f64) -> f64 {
    f_tail(r * r * (n - 2.0) / (1.0 - r * r), 1.0, n - 2.0)
}

/// Probability of `chi²` or more with two degrees of freedom.
pub(super) fn chi_square_2_tail(chi_square: f64) -> f64 {
    (-0.5 * chi_square).exp()
}

/// Probability of at least `least` of `n` correct answers by chance.
pub(super) fn binomial_tail(n: f64, least: f64, chance: f64) -> f64 {
    // From 0 correct answers on: the ratio of each term to the one before it is known.
    let (mut term, mut tail, mut k) = ((1.0 - chance).powf(n), 0.0, 0.0);
    while k <= n {
        if k >= least {
            tail += term;
        }
        term *= (n - k) / (k + 1.0) * chance / (1.0 - chance);
        k += 1.0;
    }
    tail
}

/// Probability that the range of a number of means exceeds `q` standard errors (Tukey).
pub(super) fn range_tail(q: f64, means: f64, of_error: f64) -> f64 {
    let within = |width: f64| {
        means
            * integral((-8.0, 8.0), 400, |z| {
                normal_density(z) * (normal(z) - normal(z - width)).powf(means - 1.0)
            })
    };
    // Standard deviation of the sample over that of the population, without its constant factor.
    let density =
        |s: f64| (s * (0.5 * (1.0 - s * s)).exp()).powf(of_error - 1.0) * (-0.5 * s * s).exp();
    let over =
        |function: &dyn Fn(f64) -> f64| integral((0.0, 3.0), 400, |s| density(s) * function(s));
    1.0 - over(&|s| within(q * s)) / over(&|_| 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-3, "{value}, {expected}");
    }

    /// Quantiles of printed tables.
    #[test]
    fn tails_are_those_of_the_tables() {
        assert_close(f_tail(5.117_355, 1.0, 9.0), 0.05);
        assert_close(f_tail(3.890_308, 4.0, 36.0), 0.01);
        assert_close(t_tail(2.262_157, 9.0), 0.05);
        assert_close(r_tail(0.878_339, 5.0), 0.05);
        assert_close(chi_square_2_tail(5.991_465), 0.05);
    }

    #[test]
    fn a_range_of_two_means_is_a_t_test() {
        let q: f64 = 3.67;
        assert_close(range_tail(q, 2.0, 36.0), t_tail(q / 2f64.sqrt(), 36.0));
    }

    #[test]
    fn binomial_tail_of_few_answers_is_a_sum_by_hand() {
        assert_close(binomial_tail(3.0, 2.0, 0.5), 0.5);
        assert_close(binomial_tail(2.0, 1.0, 1.0 / 3.0), 5.0 / 9.0);
    }
}

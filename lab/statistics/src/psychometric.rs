//! Psychometric function: proportion correct by level of the stimulus, fitted by maximum likelihood.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

use crate::distribution::{chi_square_tail, normal_cdf, normal_density, normal_quantile};
use crate::error::{at_least, checked, finite, inner_probability};
use crate::proportion::Proportion;
use crate::sample::{mean_of, sum_of_squares};
use crate::search::golden_section;
use crate::{Interval, Result, StatisticsError};

mod maximum;

/// Form of the function without guessing and lapses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `G = 1 - exp(-(x / location)^slope)` of a positive level `x`.
    Weibull,
    /// `G = Phi(slope (x - location))`; the slope is the inverse of the standard deviation.
    CumulativeNormal,
}

/// `p = guess + (1 - guess - lapse) G(x)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Form of `G`.
    pub shape: Shape,
    /// Proportion correct without a stimulus, from 0 to 1: 0.5 for 2AFC.
    pub guess: f64,
    /// Proportion of wrong answers to the strongest stimulus, from 0; guess and lapse are below 1 together.
    pub lapse: f64,
}

/// Answers at one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Level of the stimulus.
    pub level: f64,
    /// Correct answers at it.
    pub answers: Proportion,
}

/// A fitted psychometric function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The model; a fitted lapse rate is in it.
    pub model: Model,
    /// Level at which `G` is `1 - 1/e` (Weibull) or 0.5 (normal).
    pub location: f64,
    /// Exponent of the Weibull function, or inverse standard deviation of the normal one, per unit of the level.
    pub slope: f64,
    /// Logarithm of the likelihood of the answers, without binomial coefficients.
    pub log_likelihood: f64,
    /// Twice the logarithm of the likelihood by which proportions as observed are better. About chi-squared distributed with
    /// the number of levels less 2 as degrees of freedom, if there are many answers at each level.
    pub deviance: f64,
    /// Probability of this deviance or a larger one, by that distribution; `None` with two levels.
    pub deviance_p: Option<f64>,
    line: Line,
    /// Covariance of intercept and slope of the line: variances, and covariance last.
    covariance: [f64; 3],
}

/// Level at which a proportion correct is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The level.
    pub level: f64,
    /// Its standard error from the Fisher information, guess and lapse taken as known.
    pub standard_error: f64,
}

/// Result of a bootstrap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bootstrap {
    /// Percentile interval of the threshold.
    pub interval: Interval,
    /// Standard deviation of the thresholds.
    pub standard_error: f64,
    /// Samples without a fit, which are left out.
    pub failed: usize,
}

/// The argument of `G` as a line of the standardised level, `intercept + slope (u - centre) / spread`, where `u` is the level or
/// its logarithm: on this scale the two parameters are nearly uncorrelated and about 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    centre: f64,
    spread: f64,
    intercept: f64,
    slope: f64,
}

/// Standardised level, correct and wrong answers.
type Point = (f64, f64, f64);

impl Model {
    /// Maximum likelihood fit of location and slope, by Newton's method and Fisher's scoring from a grid of slopes.
    ///
    /// # Errors
    /// Guess or lapse out of range, a level that is not finite or (Weibull) not positive, fewer than two different levels, or
    /// answers that determine no slope: a step from the guess rate to 1 less the lapse rate, or the same proportion at all levels,
    /// is as likely as the most likely rising function.
    pub fn fit(&self, levels: &[Level]) -> Result<Fit> {
        let (line, points) = self.prepare(levels)?;
        let undetermined = StatisticsError::NotDetermined { what: "the slope" };
        let line = self.maximise(line, &points).ok_or_else(|| undetermined.clone())?;
        let (_, information) = self.score(&line, &points);
        let [aa, bb, ab] = information;
        let determinant = aa * bb - ab * ab;
        if !(line.slope > 0.0 && determinant > 1e-12 * aa * bb) {
            return Err(undetermined);
        }
        let log_likelihood = self.log_likelihood(&line, &points);
        let saturated: f64 = points
            .iter()
            .map(|&(_, k, wrong)| term(k, k / (k + wrong)) + term(wrong, wrong / (k + wrong)))
            .sum();
        // Rounding may make it negative where the fit is exact.
        let deviance = (2.0 * (saturated - log_likelihood)).max(0.0);
        let df = points.len() - 2;
        let fit = Fit {
            model: *self,
            location: self.shape.level(line.level_at(0.0)),
            slope: line.slope / line.spread,
            log_likelihood,
            deviance,
            deviance_p: match df {
                0 => None,
                _ => Some(chi_square_tail(deviance, df as f64)?),
            },
            line,
            covariance: [bb / determinant, aa / determinant, -ab / determinant],
        };
        if fit.location.is_finite() && fit.slope.is_finite() { Ok(fit) } else { Err(undetermined) }
    }

    /// As [`fit`](Self::fit), with the lapse rate from 0 to `lapse_max` that makes the answers most likely, to 1e-9; the
    /// model's own is not used. A lapse rate that is free without limit spoils the slope (Wichmann and Hill, 2001), so
    /// `lapse_max` is about 0.06.
    ///
    /// # Errors
    /// Those of [`fit`](Self::fit) with that lapse rate, or `lapse_max` out of range.
    pub fn fit_with_lapse(&self, levels: &[Level], lapse_max: f64) -> Result<Fit> {
        /// Steps of a grid in which the best lapse rate is searched first.
        const LAPSES: u32 = 8;
        /// Gain of log-likelihood that may be rounding.
        const ROUNDING: f64 = 1e-9;
        let with = |lapse| Self { lapse, ..*self };
        let (line, points) = with(lapse_max).prepare(levels)?;
        // Steps count, too: a lapse rate with which a step is most likely must not lose against one with a worse function.
        let unlikely = |lapse: f64| -with(lapse).supremum(line, &points);
        let grid = |step: u32| lapse_max * f64::from(step) / f64::from(LAPSES);
        let of_grid: Vec<f64> = (0..=LAPSES).map(|step| unlikely(grid(step))).collect();
        let step = (0..=LAPSES).zip(&of_grid).min_by(|one, other| one.1.total_cmp(other.1));
        let (step, at_step) = step.map_or((0, f64::INFINITY), |(step, at_step)| (step, *at_step));
        let (low, high) = (grid(step.saturating_sub(1)), grid((step + 1).min(LAPSES)));
        let inner = golden_section(unlikely, low, high);
        // Golden section does not reach the ends of its interval, which may be no lapses, or most of them.
        let lapse = if unlikely(inner) < at_step - ROUNDING { inner } else { grid(step) };
        with(lapse).fit(levels)
    }

    fn check(&self) -> Result<()> {
        checked("guess rate", self.guess, "from 0 to below 1", |guess| {
            (0.0..1.0).contains(&guess)
        })?;
        checked("lapse rate", self.lapse, "from 0, and below 1 with the guess rate", |lapse| {
            lapse >= 0.0 && lapse + self.guess < 1.0
        })?;
        Ok(())
    }

    /// Standardised points, equal levels joined, and a line without parameters.
    fn prepare(&self, levels: &[Level]) -> Result<(Line, Vec<Point>)> {
        self.check()?;
        let mut of_levels: Vec<Point> = Vec::new();
        let mut sorted = levels.to_vec();
        sorted.sort_by(|a, b| a.level.total_cmp(&b.level));
        for Level { level, answers } in sorted {
            let u = self.shape.scaled(level)?;
            let correct = f64::from(answers.correct());
            let wrong = f64::from(answers.total()) - correct;
            match of_levels.last_mut() {
                Some((last, k, w)) if *last == u => {
                    *k += correct;
                    *w += wrong;
                }
                _ => of_levels.push((u, correct, wrong)),
            }
        }
        at_least("levels", of_levels.len(), 2)?;
        let us: Vec<f64> = of_levels.iter().map(|point| point.0).collect();
        let centre = mean_of(&us);
        let spread = (sum_of_squares(&us) / us.len() as f64).sqrt();
        for point in &mut of_levels {
            point.0 = (point.0 - centre) / spread;
        }
        let line = Line { centre, spread, intercept: 0.0, slope: 1.0 };
        Ok((line, of_levels))
    }

    /// Probabilities of a correct and a wrong answer, and derivative of the former, by the argument of `G`.
    fn probabilities(&self, z: f64) -> (f64, f64, f64) {
        let rise = 1.0 - self.guess - self.lapse;
        let (below, above, density) = match self.shape {
            Shape::Weibull => {
                let hazard = z.exp();
                (-(-hazard).exp_m1(), (-hazard).exp(), (z - hazard).exp())
            }
            Shape::CumulativeNormal => (normal_cdf(z), normal_cdf(-z), normal_density(z)),
        };
        (self.guess + rise * below, self.lapse + rise * above, rise * density)
    }

    fn log_likelihood(&self, line: &Line, points: &[Point]) -> f64 {
        let of_point = |&(x, correct, wrong): &Point| {
            let (p, q, _) = self.probabilities(line.at(x));
            term(correct, p) + term(wrong, q)
        };
        points.iter().map(of_point).sum()
    }

    /// Derivatives of the log-likelihood by intercept and slope, and the Fisher information: both diagonal terms, and the
    /// other one.
    fn score(&self, line: &Line, points: &[Point]) -> ([f64; 2], [f64; 3]) {
        let (mut score, mut information) = ([0.0; 2], [0.0; 3]);
        for &(x, correct, wrong) in points {
            let (p, q, derivative) = self.probabilities(line.at(x));
            // Where the function is level, the point says nothing of the line.
            if derivative == 0.0 || p * q == 0.0 {
                continue;
            }
            // Near the ends of the function p or q and the derivative are tiny; their quotients are not.
            let (of_p, of_q) = (derivative / p, derivative / q);
            let of_z = correct * of_p - wrong * of_q;
            let weight = (correct + wrong) * of_p * of_q;
            score[0] += of_z;
            score[1] += of_z * x;
            information[0] += weight;
            information[1] += weight * x * x;
            information[2] += weight * x;
        }
        (score, information)
    }

    /// Argument of `G` at a proportion correct.
    fn argument(&self, proportion: f64) -> Result<f64> {
        let allowed = "above the guess rate, and below 1 less the lapse rate";
        checked("proportion of the threshold", proportion, allowed, |p| {
            p > self.guess && p < 1.0 - self.lapse
        })?;
        let part = (proportion - self.guess) / (1.0 - self.guess - self.lapse);
        match self.shape {
            Shape::Weibull => Ok((-(-part).ln_1p()).ln()),
            Shape::CumulativeNormal => normal_quantile(part),
        }
    }
}

impl Fit {
    /// Proportion correct at a level, from the guess rate to 1 less the lapse rate.
    ///
    /// # Errors
    /// A level that is not finite or, for the Weibull function, not positive.
    pub fn probability(&self, level: f64) -> Result<f64> {
        let u = self.model.shape.scaled(level)?;
        let x = (u - self.line.centre) / self.line.spread;
        Ok(self.model.probabilities(self.line.at(x)).0)
    }

    /// Level at which a proportion correct is reached, such as 0.75.
    ///
    /// # Errors
    /// A proportion that the function does not reach.
    pub fn threshold(&self, proportion: f64) -> Result<Threshold> {
        let z = self.model.argument(proportion)?;
        let u = self.line.level_at(z);
        let level = self.model.shape.level(u);
        let x = (u - self.line.centre) / self.line.spread;
        let [intercept, slope, both] = self.covariance;
        let variance = intercept + 2.0 * x * both + x * x * slope;
        let of_u = self.line.spread * variance.max(0.0).sqrt() / self.line.slope;
        let standard_error = match self.model.shape {
            Shape::Weibull => level * of_u,
            Shape::CumulativeNormal => of_u,
        };
        if level.is_finite() && standard_error.is_finite() {
            Ok(Threshold { level, standard_error })
        } else {
            Err(StatisticsError::NotDetermined { what: "the threshold" })
        }
    }

    /// Parametric bootstrap of the threshold: answers are drawn `samples` times from the fitted function, at the levels and in
    /// the numbers of `levels`, and fitted again. The same seed gives the same result. Guess and lapse stay as they are.
    ///
    /// # Errors
    /// Fewer than 100 samples, a confidence that is not between 0 and 1, the errors of [`threshold`](Self::threshold), or more
    /// than a tenth of the samples without a fit.
    pub fn bootstrap(
        &self,
        levels: &[Level],
        proportion: f64,
        confidence: f64,
        samples: usize,
        seed: u64,
    ) -> Result<Bootstrap> {
        at_least("samples", samples, 100)?;
        let rest = 0.5 * (1.0 - inner_probability("confidence", confidence)?);
        self.threshold(proportion)?;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut thresholds = Vec::with_capacity(samples);
        for _ in 0..samples {
            let mut drawn = levels.to_vec();
            for level in &mut drawn {
                let p = self.probability(level.level)?;
                let total = level.answers.total();
                let correct = (0..total).filter(|_| random.random::<f64>() < p).count();
                level.answers = Proportion::new(correct as u32, total)?;
            }
            let fit = self.model.fit(&drawn);
            thresholds.extend(fit.and_then(|fit| fit.threshold(proportion)).map(|t| t.level));
        }
        let failed = samples - thresholds.len();
        if failed * 10 > samples {
            return Err(StatisticsError::NotDetermined {
                what: "the threshold of one bootstrap sample in ten",
            });
        }
        thresholds.sort_by(f64::total_cmp);
        Ok(Bootstrap {
            interval: Interval {
                low: quantile(&thresholds, rest),
                high: quantile(&thresholds, 1.0 - rest),
            },
            standard_error: crate::standard_deviation(&thresholds)?,
            failed,
        })
    }
}

impl Shape {
    /// Level on the scale on which the argument of `G` is a line.
    fn scaled(self, level: f64) -> Result<f64> {
        match self {
            Self::Weibull => {
                let level = finite("level", level)?;
                Ok(checked("level", level, "positive", |level| level > 0.0)?.ln())
            }
            Self::CumulativeNormal => finite("level", level),
        }
    }

    fn level(self, u: f64) -> f64 {
        match self {
            Self::Weibull => u.exp(),
            Self::CumulativeNormal => u,
        }
    }
}

impl Line {
    fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }

    /// Scaled level at which the line has a value.
    fn level_at(&self, z: f64) -> f64 {
        self.centre + self.spread * (z - self.intercept) / self.slope
    }
}

/// `n ln p`, 0 without answers.
fn term(count: f64, probability: f64) -> f64 {
    if count == 0.0 { 0.0 } else { count * probability.ln() }
}

/// Quantile of sorted values, with linear interpolation.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let position = part * (sorted.len() - 1) as f64;
    let below = (position as usize).min(sorted.len() - 2);
    sorted[below] + (position - below as f64) * (sorted[below + 1] - sorted[below])
}

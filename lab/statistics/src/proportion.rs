//! Proportions of correct answers, and whether they are above chance.

use crate::distribution::binomial_tail;
use crate::error::{checked, inner_probability};
use crate::search::bisect;
use crate::{Interval, Result, StatisticsError};

/// Correct answers among all answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Proportion {
    correct: u32,
    total: u32,
}

impl Proportion {
    /// `correct` of `total` answers.
    ///
    /// # Errors
    /// No answers, or more correct ones than all.
    pub fn new(correct: u32, total: u32) -> Result<Self> {
        crate::error::at_least("answers", total as usize, 1)?;
        checked(
            "number of correct answers",
            f64::from(correct),
            "at most that of all answers",
            |_| correct <= total,
        )?;
        Ok(Self { correct, total })
    }

    /// Number of correct answers.
    pub fn correct(self) -> u32 {
        self.correct
    }

    /// Number of answers.
    pub fn total(self) -> u32 {
        self.total
    }

    /// `p = k / n`, from 0 to 1.
    pub fn value(self) -> f64 {
        f64::from(self.correct) / f64::from(self.total)
    }

    /// Standard error of the proportion, `sqrt(p (1 - p) / n)`: 0 if all or no answers are correct, for which
    /// [`interval`](Self::interval) is meant.
    pub fn standard_error(self) -> f64 {
        let p = self.value();
        (p * (1.0 - p) / f64::from(self.total)).sqrt()
    }

    /// Log-linear estimate `(k + 1/2) / (n + 1)`: never 0 or 1, so that its sensitivity is finite (Hautus, 1995).
    pub fn log_linear(self) -> f64 {
        (f64::from(self.correct) + 0.5) / (f64::from(self.total) + 1.0)
    }

    /// Probability of as many correct answers or more by chance; exact.
    ///
    /// # Errors
    /// A chance that is not from 0 to 1.
    pub fn p_by_chance(self, chance: f64) -> Result<f64> {
        binomial_tail(self.total, self.correct, chance)
    }

    /// Distance from chance in standard errors of chance, `z = (p - c) / sqrt(c (1 - c) / n)`.
    ///
    /// # Errors
    /// A chance that is not between 0 and 1.
    pub fn z(self, chance: f64) -> Result<f64> {
        let chance = inner_probability("chance", chance)?;
        let error = (chance * (1.0 - chance) / f64::from(self.total)).sqrt();
        Ok((self.value() - chance) / error)
    }

    /// Interval that contains the true proportion with at least the confidence, such as 0.95 (Clopper and Pearson, 1934):
    /// its ends are the proportions for which as many answers or more, as many or fewer, have half of the rest.
    ///
    /// # Errors
    /// A confidence that is not between 0 and 1.
    pub fn interval(self, confidence: f64) -> Result<Interval> {
        let rest = 0.5 * (1.0 - inner_probability("confidence", confidence)?);
        let Self { correct, total } = self;
        let tail = |least| move |p| binomial_tail(total, least, p).unwrap_or(1.0);
        Ok(Interval {
            low: match correct {
                0 => 0.0,
                _ => bisect(tail(correct), rest, 0.0, 1.0),
            },
            high: match total - correct {
                0 => 1.0,
                _ => bisect(tail(correct + 1), 1.0 - rest, 0.0, 1.0),
            },
        })
    }
}

/// Smallest number of correct answers of `total` that is above chance: as many or more have by chance a probability below
/// `alpha`. `None` if not even all correct answers are.
///
/// # Errors
/// A chance or an alpha that is not between 0 and 1.
pub fn criterion(total: u32, chance: f64, alpha: f64) -> Result<Option<u32>> {
    let chance = inner_probability("chance", chance)?;
    let alpha = inner_probability("alpha", alpha)?;
    // The tail falls with the number of correct answers.
    let (mut above, mut below) = (total, 0);
    if binomial_tail(total, total, chance)? >= alpha {
        return Ok(None);
    }
    while above - below > 1 {
        let middle = below + (above - below) / 2;
        if binomial_tail(total, middle, chance)? < alpha {
            above = middle;
        } else {
            below = middle;
        }
    }
    Ok(Some(above))
}

impl TryFrom<(u32, u32)> for Proportion {
    type Error = StatisticsError;

    fn try_from((correct, total): (u32, u32)) -> Result<Self> {
        Self::new(correct, total)
    }
}

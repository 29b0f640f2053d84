//! Analysis of variance: F tests of factors between and within subjects, their effect sizes, Greenhouse and Geisser's
//! correction, and planned contrasts.
//!
//! Data are cells: one number for each subject and combination of levels, such as a proportion of correct answers or a mean.
//! Every cell must be there; a missing one is an error, never a guess.

mod between;
mod contrast;
mod repeated_measures;
mod split_plot;
mod two_within;
mod within_effect;

pub use between::{OneWay, one_way};
pub use contrast::{Contrast, contrast_between, contrast_within};
pub use repeated_measures::{RepeatedMeasures, repeated_measures};
pub use split_plot::{SplitPlot, split_plot};
pub use two_within::{TwoWithin, two_within};

use crate::Result;
use crate::distribution::f_tail;

/// One effect of an analysis of variance, tested against its error term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Sum of squares of the effect, in the square of the data's unit.
    pub sum_of_squares: f64,
    /// Degrees of freedom of the effect.
    pub df: f64,
    /// Sum of squares of the error term.
    pub error_sum_of_squares: f64,
    /// Degrees of freedom of the error term.
    pub error_df: f64,
    /// Mean square of the effect over that of the error.
    pub f: f64,
    /// Probability of this `F` or a larger one without an effect.
    pub p: f64,
    /// Part of the sum of squares of effect and error that is the effect's, from 0 to 1.
    pub partial_eta_squared: f64,
    /// Departure from sphericity; `None` for a factor between subjects.
    pub sphericity: Option<Sphericity>,
}

/// Departure from sphericity, and the probability corrected for it (Greenhouse and Geisser, 1959).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphericity {
    /// Factor of both degrees of freedom, from `1 / df` of the effect to 1, which is sphericity: `tr(S)² / (df tr(S²))` of the
    /// covariance `S` of the effect's contrasts.
    pub epsilon: f64,
    /// Probability of `F` or a larger one with both degrees of freedom times epsilon.
    pub p: f64,
}

impl Effect {
    /// Mean square of the error term.
    pub fn mean_square_error(&self) -> f64 {
        self.error_sum_of_squares / self.error_df
    }

    /// An effect from its sums of squares, that of the error not zero.
    pub(crate) fn new(
        (sum_of_squares, df): (f64, f64),
        (error_sum_of_squares, error_df): (f64, f64),
        epsilon: Option<f64>,
    ) -> Result<Self> {
        let f = (sum_of_squares / df) / (error_sum_of_squares / error_df);
        let sphericity = epsilon.map(|epsilon| -> Result<_> {
            let p = f_tail(f, epsilon * df, epsilon * error_df)?;
            Ok(Sphericity { epsilon, p })
        });
        Ok(Self {
            sum_of_squares,
            df,
            error_sum_of_squares,
            error_df,
            f,
            p: f_tail(f, df, error_df)?,
            partial_eta_squared: sum_of_squares / (sum_of_squares + error_sum_of_squares),
            sphericity: sphericity.transpose()?,
        })
    }
}

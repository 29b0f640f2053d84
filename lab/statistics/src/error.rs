//! Why a score or a statistic cannot be computed.

/// Result of this crate.
pub type Result<T> = std::result::Result<T, StatisticsError>;

/// Why a score or a statistic cannot be computed. What would be no number is one of these errors instead.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StatisticsError {
    /// An argument lies outside its range, or is no number.
    #[error("{what} is {value}; it must be {allowed}")]
    OutOfRange {
        /// The argument.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its range.
        allowed: &'static str,
    },
    /// An observation is no number, or too large for its square to be one.
    #[error(
        "observation {column} of {what} {row}, counted from 0, is not a number from -1e100 to 1e100"
    )]
    NotFinite {
        /// What a row of the data is: a subject, a group.
        what: &'static str,
        /// Number of the row, from 0.
        row: usize,
        /// Number of the observation in the row, from 0.
        column: usize,
    },
    /// Fewer subjects, groups, levels or observations than the statistic needs.
    #[error("{count} {what}; at least {least} are needed")]
    TooFew {
        /// What there are too few of.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many are needed.
        least: usize,
    },
    /// A row has more or fewer cells than the first one: a cell is missing, or the design is not balanced.
    #[error(
        "{what} {row} has {count} observations, the first one {expected}: every cell must be there once"
    )]
    Unbalanced {
        /// What a row of the data is.
        what: &'static str,
        /// Number of the row, from 0.
        row: usize,
        /// Its observations.
        count: usize,
        /// Observations of the first row.
        expected: usize,
    },
    /// A variance by which the statistic is divided is zero, as where all answers were equal.
    #[error("{what} does not vary, so the statistic is not defined")]
    NoVariation {
        /// What does not vary.
        what: &'static str,
    },
    /// The data do not determine a parameter of a fit.
    #[error("the data do not determine {what}")]
    NotDetermined {
        /// The parameter.
        what: &'static str,
    },
    /// A name is used twice, or is not known.
    #[error("the label '{label}' {why}")]
    Label {
        /// The name.
        label: String,
        /// What is wrong with it.
        why: &'static str,
    },
}

/// `value`, if it is in its range. The range must exclude what is no number.
pub(crate) fn checked(
    what: &'static str,
    value: f64,
    allowed: &'static str,
    is_allowed: impl Fn(f64) -> bool,
) -> Result<f64> {
    if is_allowed(value) {
        Ok(value)
    } else {
        Err(StatisticsError::OutOfRange { what, value, allowed })
    }
}

/// A probability between 0 and 1, both excluded.
pub(crate) fn inner_probability(what: &'static str, value: f64) -> Result<f64> {
    checked(what, value, "between 0 and 1, both excluded", |p| p > 0.0 && p < 1.0)
}

/// A finite number whose square is one, too.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64> {
    checked(what, value, "a number from -1e100 to 1e100", is_number)
}

/// Whether a number and the sums of its squares are finite.
pub(crate) fn is_number(value: f64) -> bool {
    value.abs() <= 1e100
}

/// At least so many.
pub(crate) fn at_least(what: &'static str, count: usize, least: usize) -> Result<()> {
    if count < least {
        return Err(StatisticsError::TooFew { what, count, least });
    }
    Ok(())
}

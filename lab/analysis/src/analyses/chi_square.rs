//! What is said beside a chi-squared test.

use experiment_statistics::chi_square::ChiSquare;

/// Expected count below which the distribution of chi-squared is a poor approximation.
const EXPECTED_MIN: f64 = 5.0;

/// A warning, if an expected count is too small.
pub fn warning(what: &str, test: &ChiSquare) -> Option<String> {
    (test.smallest_expected < EXPECTED_MIN).then(|| {
        format!(
            "{what}: an expected count is {:.1}, below {EXPECTED_MIN}; p of chi-squared is a poor approximation.",
            test.smallest_expected
        )
    })
}

//! Tests that take some of many similar cases.

/// A variable of the environment: with `all`, tests that otherwise take one of so many similar cases take each of them.
const VARIABLE: &str = "THERMAL_CASES";

/// The step through similar cases: `suite`, 1 or more, or 1 where all of them are asked for (`cargo xtask soak --only cases`).
pub fn one_case_in(suite: usize) -> usize {
    if takes_all_cases() { 1 } else { suite }
}

pub(crate) fn takes_all_cases() -> bool {
    std::env::var(VARIABLE).is_ok_and(|cases| cases == "all")
}

#![doc = include_str!("../README.md")]

use std::fmt;
use std::sync::LazyLock;

mod cases;
mod check;
mod constants;
mod generator;
mod parse;
mod prose;

pub use cases::one_case_in;
pub use check::Verdict;
pub use constants::Constants;
pub use generator::{GENERATORS_REQUIRED, VIRTUAL_ENVIRONMENT, python_with_mpmath, run_generator};
pub use prose::{ResultInProse, is_head_of_records, results};

/// The source of all figures.
const TEXT: &str = include_str!("../../docs/figures.toml");
static ALL: LazyLock<Vec<Figure>> =
    LazyLock::new(|| parse::figures(TEXT).unwrap_or_else(|error| panic!("figures.toml: {error}")));

/// Largest ratio of a bound to its value, and of a value to what is measured, without a reason.
pub const HEADROOM: f64 = 1.3;

/// A number as the documentation prints it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(untagged)]
pub enum Number {
    /// A count.
    Whole(i64),
    /// A measurement.
    Real(f64),
}

impl Number {
    /// As a floating-point number.
    pub const fn get(self) -> f64 {
        match self {
            Self::Whole(value) => value as f64,
            Self::Real(value) => value,
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(value) => write!(f, "{value}"),
            Self::Real(value) => write!(f, "{value:?}"),
        }
    }
}

/// What a test demands of the measured number.
#[derive(Clone, Debug, PartialEq)]
pub enum Demand {
    /// It is at most this.
    AtMost(Number),
    /// It is at least this.
    AtLeast(Number),
    /// It is at least the first and at most the second.
    Between(Number, Number),
    /// It is the stated value.
    Exactly,
    /// No test measures it: recorded by its command at this commit.
    Recorded(String),
}

/// One documented figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its name, `group.name`.
    pub key: String,
    /// What it is, for a reader.
    pub what: String,
    /// The stated value; several in a row of a table, which a test demands exactly.
    pub values: Vec<Number>,
    /// What a test demands.
    pub demand: Demand,
    /// Unit of value and bound; empty for a count.
    pub unit: String,
    /// Where it holds.
    pub domain: String,
    /// What measures it.
    pub command: String,
    /// Why the bound is more than [`HEADROOM`] from the value.
    pub why: Option<String>,
    /// The compiler that it depends on, such as `rustc 1.95.0`.
    pub recorded_with: Option<String>,
}

impl Figure {
    /// The stated value, or the first of several.
    pub fn value(&self) -> f64 {
        self.values.first().map_or(f64::NAN, |value| value.get())
    }

    /// As the documentation prints it; several as cells of a table.
    pub fn shown(&self) -> String {
        let values: Vec<_> = self.values.iter().map(Number::to_string).collect();
        values.join(" | ")
    }
}

/// All figures, in the order of the file.
pub fn all() -> &'static [Figure] {
    &ALL
}

/// The figure of a key.
///
/// # Panics
/// There is none.
pub fn figure(key: &str) -> &'static Figure {
    let found = all().iter().find(|figure| figure.key == key);
    found.unwrap_or_else(|| panic!("docs/figures.toml has no figure {key}"))
}

/// Prints what was measured, and compares it with the documented figure.
///
/// # Panics
/// It is beyond the bound, or so much better than stated that the documentation is out of date.
#[track_caller]
pub fn assert_figure(key: &str, measured: f64) {
    let figure = figure(key);
    figure.print(measured);
    assert!(figure.recorded_with.is_none(), "{key} depends on the compiler: assert_compiled");
    if let Verdict::Differs(why) = figure.judge(measured) {
        panic!("{why}");
    }
}

/// The same as [`assert_figure`] for what is measured over steps of [`one_case_in`]: on some of the figure's cases it may be
/// any better than stated.
///
/// # Panics
/// It is beyond the bound; or as [`assert_figure`], if all cases are asked for.
#[track_caller]
pub fn assert_sampled(key: &str, measured: f64) {
    if cases::takes_all_cases() {
        return assert_figure(key, measured);
    }
    let figure = figure(key);
    figure.print(measured);
    if let Some(problem) = figure.beyond(measured) {
        panic!("{key}, some of its cases: {measured:?} {problem}; {figure}");
    }
}

/// Compares a row of measured numbers with the documented row.
///
/// # Panics
/// A number differs.
#[track_caller]
pub fn assert_row(key: &str, measured: &[f64]) {
    let stated: Vec<f64> = figure(key).values.iter().map(|value| value.get()).collect();
    println!("{key}: measured {measured:?}");
    assert_eq!(stated, measured, "{key}: documented, measured");
}

/// The same as [`assert_figure`] for a figure that depends on the compiler; under another one a difference is a printed warning.
///
/// # Panics
/// As [`assert_figure`], under the compiler that the figure was recorded with.
#[track_caller]
pub fn assert_compiled(key: &str, measured: f64, compiler: &str) {
    let figure = figure(key);
    figure.print(measured);
    if let Verdict::Differs(why) = figure.judge(measured) {
        assert!(!figure.holds_for(compiler), "{why}");
        println!("warning: {why}; this is {compiler}");
    }
}

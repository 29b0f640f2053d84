//! Scores and statistics against exact values, those of the thesis, those of established packages, and properties.

mod direct_maximum;
mod errors;
mod exact;
mod packages;
mod properties;
mod psychometric;
mod staircase;

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;

fn table<T: DeserializeOwned>(text: &str) -> Vec<T> {
    let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
    rows.collect::<Result<_, _>>().expect("a golden table")
}

/// Largest relative error of each quantity.
#[derive(Default)]
struct Errors(BTreeMap<String, (f64, usize)>);

impl Errors {
    /// Compares a value with the exact one, relative to it.
    fn add(&mut self, quantity: &str, value: f64, exact: f64) {
        self.add_relative_to(quantity, value, exact, exact.abs());
    }

    /// Compares a value with the exact one, relative to a size, for an exact value of about zero.
    fn add_relative_to(&mut self, quantity: &str, value: f64, exact: f64, size: f64) {
        let error = if value == exact { 0.0 } else { (value - exact).abs() / size };
        assert!(!error.is_nan(), "{quantity}: {value} for {exact}");
        let (worst, count) = self.0.entry(quantity.into()).or_default();
        *worst = worst.max(error);
        *count += 1;
    }

    /// Prints the errors, and asserts the bound of each quantity.
    #[track_caller]
    fn assert(&self, bounds: &[(&str, f64)]) {
        for (quantity, (worst, count)) in &self.0 {
            println!("{quantity}: largest relative error {worst:.1e} of {count}");
            let bound = bounds.iter().find(|(name, _)| name == quantity);
            let (_, bound) = bound.unwrap_or_else(|| panic!("{quantity} has no bound"));
            assert!(worst <= bound, "{quantity}: {worst:e} is above {bound:e}");
        }
        assert_eq!(self.0.len(), bounds.len(), "a quantity was not compared");
    }
}

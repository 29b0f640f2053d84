//! Results of benches, compared with what is allowed.

use std::fmt;

use serde::Serialize;

/// One simulated quantity, and the interval in which it must be.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// What it is.
    pub name: String,
    /// Simulated value.
    pub value: f64,
    /// Its unit; 1 is a pure number.
    pub unit: &'static str,
    /// Least allowed value; absent if there is none.
    pub least: Option<f64>,
    /// Largest allowed value; absent if there is none.
    pub most: Option<f64>,
}

impl Quantity {
    /// A quantity that must be from `least` to `most`.
    pub fn between(
        name: impl Into<String>,
        value: f64,
        unit: &'static str,
        (least, most): (f64, f64),
    ) -> Self {
        Self { name: name.into(), value, unit, least: Some(least), most: Some(most) }
    }

    /// A quantity that must not exceed `most`.
    pub fn at_most(name: impl Into<String>, value: f64, unit: &'static str, most: f64) -> Self {
        Self { least: None, ..Self::between(name, value, unit, (most, most)) }
    }

    /// A quantity that must not be below `least`.
    pub fn at_least(name: impl Into<String>, value: f64, unit: &'static str, least: f64) -> Self {
        Self { most: None, ..Self::between(name, value, unit, (least, least)) }
    }

    /// Whether the value is allowed.
    pub fn holds(&self) -> bool {
        self.value.is_finite()
            && self.least.is_none_or(|least| self.value >= least)
            && self.most.is_none_or(|most| self.value <= most)
    }

    /// The allowed interval in words.
    pub fn allowed(&self) -> String {
        match (self.least, self.most) {
            (Some(least), Some(most)) => format!("{} to {}", Short(least), Short(most)),
            (Some(least), None) => format!("at least {}", Short(least)),
            (None, Some(most)) => format!("at most {}", Short(most)),
            (None, None) => "any".into(),
        }
    }
}

/// A number with four significant digits, without trailing zeros.
pub struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || !size.is_finite() {
            return write!(f, "{}", self.0);
        }
        let places = (3.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
        let text = format!("{:.places$}", self.0);
        let text = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        f.write_str(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_belong_to_what_is_allowed_and_nan_does_not() {
        let within = |value| Quantity::between("x", value, "V", (1.0, 2.0)).holds();
        assert!(within(1.0) && within(2.0));
        assert!(!within(0.99) && !within(2.01) && !within(f64::NAN));
        assert!(Quantity::at_most("x", -5.0, "V", 0.0).holds());
        assert!(!Quantity::at_least("x", f64::INFINITY, "V", 0.0).holds());
    }

    #[test]
    fn numbers_have_four_digits() {
        for (value, expected) in [
            (10.03456, "10.03"),
            (0.000_123_456, "0.0001235"),
            (45.0, "45"),
            (12_345.6, "12346"),
            (-1.5, "-1.5"),
            (0.0, "0"),
        ] {
            assert_eq!(Short(value).to_string(), expected);
        }
    }
}

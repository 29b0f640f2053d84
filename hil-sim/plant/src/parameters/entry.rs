//! A parameter bound to its field.

use super::tolerance::Tolerance;
use super::{Parameter, ParameterError, Source};

/// Mutable access to the field of a parameter, and its description.
pub struct Entry<'a> {
    pub key: String,
    pub value: &'a mut f64,
    pub unit: &'static str,
    pub meaning: &'static str,
    pub tolerance: Tolerance,
    /// Least and largest allowed value.
    pub allowed: (f64, f64),
    /// Whether an infinite value is allowed, too.
    pub may_be_infinite: bool,
    pub source: Source,
}

/// Declares the parameters of parts from their rows: a function for each part that returns their entries. A field without a row is an
/// error of the compiler.
macro_rules! parameters {
    ($(
        $(#[$doc:meta])*
        fn $entries:ident($part:ident $(, $argument:ident: $kind:ty)*) named $name:tt {$(
            $field:ident
            $(: $unit:literal, $tolerance:expr, $allowed:tt $($or_infinite:ident)?, $meaning:literal, $source:expr)?
            $(=> $of_field:expr)?;
        )+}
    )+) => {$(
        $(#[$doc])*
        pub fn $entries<'a>(part: &'a mut $part $(, $argument: $kind)*) -> Vec<Entry<'a>> {
            // The error of a field without a row names the field and its struct; that of an exhaustive pattern in a macro does not.
            let _ = |part: $part| $part { $($field: part.$field),+ };
            let $part { $($field,)+ .. } = part;
            let mut all = Vec::new();
            $(
                // The field is a number, or an option of one.
                $(all.extend(Option::from($field).map(|value: &'a mut f64| Entry {
                    key: format!("{}.{}", $name, stringify!($field)),
                    value,
                    unit: $unit,
                    meaning: $meaning,
                    tolerance: $tolerance,
                    allowed: $allowed,
                    may_be_infinite: false,
                    source: $source,
                }$(.$or_infinite())?));)?
                $(all.extend($of_field);)?
            )+
            all
        }
    )+};
}
pub(super) use parameters;

impl Entry<'_> {
    /// Allows an infinite value, too.
    pub fn or_infinite(self) -> Self {
        Self { may_be_infinite: true, ..self }
    }

    /// Whether the parameter belongs to a part.
    pub fn is_of(&self, part: &str) -> bool {
        self.key.split('.').next() == Some(part)
    }

    fn is_infinite(&self) -> bool {
        self.may_be_infinite && *self.value == f64::INFINITY
    }

    pub fn parameter(&self) -> Parameter {
        let (low, high) = self.limits();
        let (least, most) = self.allowed;
        Parameter {
            key: self.key.clone(),
            value: *self.value,
            unit: self.unit,
            low,
            high,
            distribution: self.tolerance.distribution(),
            least,
            most: if self.is_infinite() { f64::INFINITY } else { most },
            source: self.source,
            meaning: self.meaning,
        }
    }

    /// Limits of the tolerance within the allowed range.
    fn limits(&self) -> (f64, f64) {
        if self.is_infinite() {
            return (f64::INFINITY, f64::INFINITY);
        }
        let (low, high) = self.tolerance.limits(*self.value);
        let (least, most) = self.allowed;
        (low.max(least), high.min(most))
    }

    pub fn draw(&mut self, seed: u64) {
        let limits = self.limits();
        *self.value = (self.tolerance.distribution()).draw(*self.value, limits, seed, &self.key);
    }

    pub fn check(&self) -> Result<(), ParameterError> {
        let (least, most) = self.allowed;
        if (least..=most).contains(self.value) || self.is_infinite() {
            return Ok(());
        }
        Err(ParameterError::OutOfRange {
            key: self.key.clone(),
            value: *self.value,
            unit: self.unit,
            least,
            most,
        })
    }
}

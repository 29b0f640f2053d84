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

/// The entry of a field, bound to a variable of the same name: unit, meaning, tolerance, allowed range, source. The part's
/// name is [prefixed](prefixed) later.
macro_rules! entry {
    ($field:ident, $unit:expr, $meaning:expr, $tolerance:expr, $allowed:expr, $source:expr $(,)?) => {
        $crate::parameters::entry::Entry {
            key: stringify!($field).into(),
            value: $field,
            unit: $unit,
            meaning: $meaning,
            tolerance: $tolerance,
            allowed: $allowed,
            may_be_infinite: false,
            source: $source,
        }
    };
}
pub(super) use entry;

/// The entries of a part with its name in front of their keys.
pub fn prefixed<'a>(
    part: &str,
    entries: impl IntoIterator<Item = Entry<'a>>,
) -> impl Iterator<Item = Entry<'a>> {
    entries.into_iter().map(move |entry| Entry { key: format!("{part}.{}", entry.key), ..entry })
}

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

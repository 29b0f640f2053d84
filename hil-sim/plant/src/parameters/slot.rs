//! A parameter in its place.

use super::spread::Tolerance;
use super::{Parameter, ParameterError, Source};

/// A number of the parts, and what is known of it.
pub struct Slot<'a> {
    pub key: String,
    pub value: &'a mut f64,
    unit: &'static str,
    meaning: &'static str,
    tolerance: Tolerance,
    /// Least and largest value that is possible.
    possible: (f64, f64),
    /// Infinite is possible, too.
    endless: bool,
    source: Source,
}

/// A number of a part whose key is still to be set [under](under) the part's.
pub fn slot<'a>(
    value: &'a mut f64,
    name: &str,
    unit: &'static str,
    meaning: &'static str,
    tolerance: Tolerance,
    possible: (f64, f64),
    source: Source,
) -> Slot<'a> {
    Slot {
        key: name.into(),
        value,
        unit,
        meaning,
        tolerance,
        possible,
        endless: false,
        source,
    }
}

/// The numbers of a part under its name.
pub fn under<'a>(
    part: &str,
    slots: impl IntoIterator<Item = Slot<'a>>,
) -> impl Iterator<Item = Slot<'a>> {
    slots.into_iter().map(move |slot| Slot {
        key: format!("{part}.{}", slot.key),
        ..slot
    })
}

impl Slot<'_> {
    /// May be infinite, too.
    pub fn or_endless(self) -> Self {
        Self {
            endless: true,
            ..self
        }
    }

    fn is_endless(&self) -> bool {
        self.endless && *self.value == f64::INFINITY
    }

    pub fn parameter(&self) -> Parameter {
        let (low, high) = self.limits();
        let (least, most) = self.possible;
        Parameter {
            key: self.key.clone(),
            value: *self.value,
            unit: self.unit,
            low,
            high,
            distribution: self.tolerance.distribution(),
            least,
            most: if self.is_endless() {
                f64::INFINITY
            } else {
                most
            },
            source: self.source,
            meaning: self.meaning,
        }
    }

    /// Limits of the tolerance, as far as they are possible.
    fn limits(&self) -> (f64, f64) {
        if self.is_endless() {
            return (f64::INFINITY, f64::INFINITY);
        }
        let (low, high) = self.tolerance.limits(*self.value);
        let (least, most) = self.possible;
        (low.max(least), high.min(most))
    }

    pub fn draw(&mut self, seed: u64) {
        let limits = self.limits();
        *self.value = (self.tolerance.distribution()).draw(*self.value, limits, seed, &self.key);
    }

    pub fn check(&self) -> Result<(), ParameterError> {
        let (least, most) = self.possible;
        if (least..=most).contains(self.value) || self.is_endless() {
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

//! The parameter box: every number that the plant's parts are made of, with its tolerance, what is possible, and
//! where it comes from.
//!
//! The tables stand beside each other, one for each part; nominal values are those of [`Params`] and stand there only.
//! What a part is drawn from are the tolerances here, each parameter by itself: what goes together in reality (the
//! conductivity of the skin in the contact and below it) is drawn apart, so the box is somewhat too wide.

mod bridge;
mod comparator;
mod finger;
mod host;
mod sensors;
mod slot;
mod spread;
mod surface;
mod tile;

use serde::Serialize;

use super::Params;
use slot::Slot;
pub use spread::{Distribution, Tolerance, absolute, between, relative, stream};

/// Where a nominal value and its tolerance come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The thesis, and where in it.
    Thesis(&'static str),
    /// Published measurements.
    Literature,
    /// A data sheet that was read.
    DataSheet,
    /// Typical of such parts, or estimated from their size.
    ClassValue,
    /// Remembered of such parts and not looked up.
    Recalled,
    /// Chosen for the reference design; the tolerance is that of the class of part.
    Design,
}

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Thesis(place) => return write!(f, "thesis {place}"),
            Self::Literature => "literature",
            Self::DataSheet => "data sheet",
            Self::ClassValue => "class value",
            Self::Recalled => "recalled",
            Self::Design => "design",
        })
    }
}

impl Serialize for Source {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// One number of the box.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name: part and field, joined by dots.
    pub key: String,
    /// Its value in the parameters that were asked.
    pub value: f64,
    /// Its unit; 1 for pure numbers.
    pub unit: &'static str,
    /// Least value that is drawn.
    pub low: f64,
    /// Largest value that is drawn.
    pub high: f64,
    /// How it is drawn between them.
    pub distribution: Distribution,
    /// Least value that is possible.
    pub least: f64,
    /// Largest value that is possible.
    pub most: f64,
    /// Where value and tolerance come from.
    pub source: Source,
    /// What it is.
    pub meaning: &'static str,
}

/// A parameter that is not there, or that cannot be so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// No parameter has this key.
    #[error("no parameter is called {key}; similar are {}", near.join(", "))]
    Unknown {
        /// The key.
        key: String,
        /// The known keys nearest to it.
        near: Vec<String>,
    },
    /// The value is not possible.
    #[error("{key} = {value} {unit}; allowed is {least} to {most}")]
    OutOfRange {
        /// The key.
        key: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Least that is possible.
        least: f64,
        /// Most that is possible.
        most: f64,
    },
}

/// Keys named where one is not known.
const SIMILAR: usize = 3;

/// All parameters, with tolerances around the given values.
#[must_use]
pub fn all(params: &Params) -> Vec<Parameter> {
    let mut params = params.clone();
    slots(&mut params).iter().map(Slot::parameter).collect()
}

/// Sets the parameter of a key. Parts that the finger does not have (layers, core, vessels) have no parameters.
///
/// # Errors
/// There is no such key, or the value is not possible: then nothing is changed.
pub fn set(params: &mut Params, key: &str, value: f64) -> Result<(), ParameterError> {
    let mut slots = slots(params);
    let Some(slot) = slots.iter_mut().find(|slot| slot.key == key) else {
        return Err(ParameterError::Unknown {
            key: key.into(),
            near: similar(&slots, key),
        });
    };
    let before = std::mem::replace(slot.value, value);
    slot.check().inspect_err(|_| *slot.value = before)
}

/// Draws every parameter within its tolerance around the given values. The seed fixes the draw; every parameter has a
/// stream of its own, so more parameters change no other's draw.
pub fn draw(params: &mut Params, seed: u64) {
    for slot in &mut slots(params) {
        slot.draw(seed);
    }
}

/// Checks that every parameter is possible by itself.
///
/// # Errors
/// The first that is not.
pub fn check(params: &Params) -> Result<(), ParameterError> {
    let mut params = params.clone();
    slots(&mut params).iter().try_for_each(Slot::check)
}

/// Every number of the parts. No part can be left out: they are taken apart field by field.
fn slots(params: &mut Params) -> Vec<Slot<'_>> {
    let Params {
        finger,
        display,
        tile,
        sensors,
        bridge,
        comparator,
        host,
    } = params;
    let mut all = finger::slots(finger);
    all.extend(surface::slots("display", display, surface::DISPLAY));
    all.extend(tile::slots(tile));
    all.extend(bridge::slots(bridge));
    all.extend(comparator::slots(comparator));
    all.extend(sensors::slots(sensors));
    all.extend(host::slots(host));
    all
}

fn similar(slots: &[Slot<'_>], key: &str) -> Vec<String> {
    let mut near: Vec<_> = slots
        .iter()
        .map(|slot| (strsim::damerau_levenshtein(&slot.key, key), &slot.key))
        .collect();
    near.sort();
    near.into_iter()
        .take(SIMILAR)
        .map(|(_, key)| key.clone())
        .collect()
}

#[cfg(test)]
mod tests;

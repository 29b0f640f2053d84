//! All parameters of the plant by key, with tolerance, allowed range and source.
//!
//! The table in `table.rs` has a row for each; the nominal values are only in [`Params`]. Parameters are drawn from their
//! tolerances independently, also those that are correlated in reality (the conductivity of the skin in the contact and below
//! it), so the drawn devices differ somewhat more than real ones.

mod entry;
mod finger_draw;
mod table;
mod tolerance;

use serde::Serialize;

use super::Params;
use entry::Entry;
pub use finger_draw::{
    BloodUnderForce, Epidermis, FingerDraw, PlaceBeforeContact, TissueDraw, draw_finger,
};
pub use tolerance::{Distribution, Tolerance, absolute, between, relative, stream_seed};

/// Source of a nominal value and its tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The thesis, at the named place.
    Thesis(&'static str),
    /// Published measurements.
    Literature,
    /// Data sheet.
    DataSheet,
    /// Typical of the class of part, or estimated from its size.
    ClassValue,
    /// Estimated for the stated reason.
    Estimate(&'static str),
    /// Simulated by the benches of the circuits in `hardware/`, or a value of their netlists.
    Netlist,
    /// Stated from memory, not looked up.
    Recalled,
    /// Chosen for the reference design; the tolerance is that of the class of part.
    Design,
}

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Thesis(place) => return write!(f, "thesis {place}"),
            Self::Estimate(reason) => return write!(f, "estimate: {reason}"),
            Self::Literature => "literature",
            Self::DataSheet => "data sheet",
            Self::ClassValue => "class value",
            Self::Netlist => "netlist",
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

/// Description of one parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Key: part and field, joined by dots.
    pub key: String,
    /// Value.
    pub value: f64,
    /// Unit; 1 for dimensionless parameters.
    pub unit: &'static str,
    /// Least value that is drawn.
    pub low: f64,
    /// Largest value that is drawn.
    pub high: f64,
    /// Distribution between them.
    pub distribution: Distribution,
    /// Least allowed value.
    pub least: f64,
    /// Largest allowed value.
    pub most: f64,
    /// Source of value and tolerance.
    pub source: Source,
    /// Meaning.
    pub meaning: &'static str,
}

/// Error of a key or a value.
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
    /// The value is outside of the allowed range.
    #[error("{key} = {value}{}; allowed is {least} to {most}", after_number(unit))]
    OutOfRange {
        /// The key.
        key: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Least allowed value.
        least: f64,
        /// Largest allowed value.
        most: f64,
    },
}

/// A unit after a number; that of a pure number is not written.
fn after_number(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// Number of similar keys named in the error of an unknown key.
const SIMILAR: usize = 3;

/// All parameters, with their tolerances around the given values.
pub fn all(params: &Params) -> Vec<Parameter> {
    let mut params = params.clone();
    entries(&mut params).iter().map(Entry::parameter).collect()
}

/// Sets the parameter of a key. Parts that are not there (layers, core and vessels of the finger, the
/// heat-flux sensor) have no keys.
///
/// # Errors
/// The key is unknown or the value out of range; nothing is changed then.
pub fn set(params: &mut Params, key: &str, value: f64) -> Result<(), ParameterError> {
    let mut entries = entries(params);
    let Some(entry) = entries.iter_mut().find(|entry| entry.key == key) else {
        return Err(ParameterError::Unknown { key: key.into(), near: similar(&entries, key) });
    };
    let before = std::mem::replace(entry.value, value);
    entry.check().inspect_err(|_| *entry.value = before)
}

/// Draws every parameter but those of the [contact](draw_contact) within its tolerance around the given values. Each
/// parameter has its own random stream, given by seed and key, so additional parameters do not change the draws of the
/// others.
pub fn draw(params: &mut Params, seed: u64) {
    let mut entries = entries(params);
    for entry in entries.iter_mut().filter(|entry| !entry.is_of(table::CONTACT)) {
        entry.draw(seed);
    }
}

/// Draws the parameters of the contact in the same way.
pub fn draw_contact(params: &mut Params, seed: u64) {
    for mut entry in table::contact(&mut params.contact) {
        entry.draw(seed);
    }
}

/// Checks that every parameter is within its allowed range.
///
/// # Errors
/// The first parameter that is not.
pub fn check(params: &Params) -> Result<(), ParameterError> {
    let mut params = params.clone();
    entries(&mut params).iter().try_for_each(Entry::check)
}

/// Entries of all parameters.
fn entries(params: &mut Params) -> Vec<Entry<'_>> {
    let Params { finger, display, contact, tile, sensors, flux, bridge, comparator, supply, host } =
        params;
    let mut all = table::finger(finger);
    all.extend(table::display(display));
    all.extend(table::contact(contact));
    all.extend(table::tile(tile));
    all.extend(table::bridge(bridge));
    all.extend(table::comparator(comparator));
    all.extend(table::supply(supply));
    all.extend(table::sensors(sensors));
    all.extend(flux.iter_mut().flat_map(table::flux));
    all.extend(table::host(host));
    all
}

fn similar(entries: &[Entry<'_>], key: &str) -> Vec<String> {
    let mut near: Vec<_> = entries
        .iter()
        .map(|entry| (strsim::damerau_levenshtein(&entry.key, key), &entry.key))
        .collect();
    near.sort();
    near.into_iter().take(SIMILAR).map(|(_, key)| key.clone()).collect()
}

#[cfg(test)]
mod tests;

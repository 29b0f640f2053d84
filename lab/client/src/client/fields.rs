//! Words of an answer or of telemetry.

use std::str::FromStr;

use serde::Serializer;
use thermal_device::StateName;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_settings::FluxSensor;
use thermal_wire::host::finite;
use thermal_wire::telemetry::UNKNOWN_WORD;

/// The words of an answer after `ok`.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a>(&'a str);

impl<'a> Fields<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self(text.trim())
    }

    /// The whole text.
    pub const fn text(&self) -> &'a str {
        self.0
    }

    pub(super) fn words(&self) -> impl Iterator<Item = &'a str> {
        self.0.split_ascii_whitespace()
    }

    /// The word behind `name=`; the first one if the name occurs twice.
    pub(super) fn word(&self, name: &str) -> Option<&'a str> {
        let mut words = self.words().filter_map(|word| word.split_once('='));
        words.find_map(|(word, value)| (word == name).then_some(value))
    }

    /// The number behind `name=`.
    pub(super) fn number<T: FromStr>(&self, name: &str) -> Option<T> {
        self.word(name)?.parse().ok()
    }

    /// The numbers behind these names.
    pub(super) fn numbers<const N: usize>(&self, names: [&str; N]) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = self.number(name)?;
        }
        Some(numbers)
    }

    /// The number behind `name=`, or `Some(None)` for `-`.
    pub(super) fn number_or_unknown(&self, name: &str) -> Option<Option<f64>> {
        number_or_unknown(self.word(name)?)
    }

    /// `0` or `1` behind `name=`.
    pub(super) fn flag(&self, name: &str) -> Option<bool> {
        match self.word(name)? {
            "0" => Some(false),
            "1" => Some(true),
            _ => None,
        }
    }
}

/// A number, or `Some(None)` for `-`.
pub fn number_or_unknown(word: &str) -> Option<Option<f64>> {
    match word {
        UNKNOWN_WORD => Some(None),
        word => finite(word).map(Some),
    }
}

/// Serializes a fault as its word.
pub fn fault_word<S: Serializer>(fault: &Fault, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(fault.name())
}

/// Serializes a state as its word.
pub fn state_word<S: Serializer>(state: &StateName, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(state.name())
}

/// Serializes a heat-flux sensor as its numbers by their names.
pub fn flux_sensor_numbers<S: Serializer>(
    sensor: &FluxSensor,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(FluxSensor::NAMES.into_iter().zip(sensor.to_array()))
}

/// Serializes what is known of a finger as its word.
pub fn knowledge_word<S: Serializer>(
    knowledge: &FingerKnowledge,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(knowledge.name())
}

//! Words of an answer or of telemetry.

use std::str::FromStr;

use serde::Serializer;
use thermal_device::StateName;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_settings::FluxSensor;

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
        "-" => Some(None),
        word => finite(word).map(Some),
    }
}

/// A finite number.
pub fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The fault with this word.
pub fn fault(word: &str) -> Option<Fault> {
    Fault::ALL.iter().copied().find(|fault| fault.name() == word)
}

/// The state with this word; a tripped one needs the word of its fault.
pub fn state(word: &str, fault_word: &str) -> Option<StateName> {
    // Every line of telemetry comes here, and the faults are many: they are searched only for a word that no other state has.
    let without_fault = [
        StateName::Off,
        StateName::SelfTest,
        StateName::Ready,
        StateName::Armed,
        StateName::Preset,
        StateName::Contact,
        StateName::Stimulus,
    ]
    .into_iter()
    .find(|state| state.name() == word);
    without_fault
        .or_else(|| fault(fault_word).map(StateName::Tripped).filter(|state| state.name() == word))
}

/// The value with this word in a table of the protocol.
pub fn in_table<T: Copy>(table: &[(&str, T)], word: &str) -> Option<T> {
    let found = table.iter().find(|(known, _)| *known == word);
    found.map(|(_, value)| *value)
}

/// What is known of a finger, by its word.
pub fn knowledge(word: &str) -> Option<FingerKnowledge> {
    let mut all = FingerKnowledge::ALL.into_iter();
    all.find(|knowledge| knowledge.name() == word)
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

/// The same, or nothing.
pub fn knowledge_word_if_known<S: Serializer>(
    knowledge: &Option<FingerKnowledge>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match knowledge {
        Some(knowledge) => knowledge_word(knowledge, serializer),
        None => serializer.serialize_none(),
    }
}

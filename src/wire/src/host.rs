//! What a host needs beside the device: readers of lines, and the declarations as tables.

mod read_telemetry;
mod requests;

use std::boxed::Box;
use std::string::String;
use std::string::ToString as _;
use std::vec::Vec;

use thermal_device::StateName;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_settings::Range;

use crate::telemetry::FIELDS_OF_EVERY_LINE;
pub use crate::telemetry::{COLUMNS, Telemetry};
pub use requests::{upload, upload_course};

/// What a word from the device can be, beside `-`.
#[derive(Clone, Copy, Debug)]
pub enum ValueForm {
    /// A decimal number.
    Number,
    /// A whole number, 0 or more.
    Count,
    /// One of these words.
    Word(fn() -> Vec<&'static str>),
}

/// A value from the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A count.
    Count(u32),
    /// A word.
    Word(&'static str),
}

/// A field of telemetry as the column of a table.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Name of the field, as `stream` takes it.
    pub field: &'static str,
    /// Name of the column: the quantity with its unit, as `display_c`.
    pub name: &'static str,
    /// Unit as BIDS writes it; empty for a count or a word.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    /// What its words can be.
    pub form: ValueForm,
    pub(crate) value: fn(&Telemetry) -> Option<Value>,
}

impl Column {
    /// The columns of lines in which the host has named no field: those that every device reports.
    pub fn default_ones() -> &'static [Self] {
        &COLUMNS[..FIELDS_OF_EVERY_LINE]
    }

    /// The columns of the heat-flux sensor; none without one. They stand at the end of a table.
    pub fn of_flux(has_sensor: bool) -> &'static [Self] {
        if has_sensor { &COLUMNS[FIELDS_OF_EVERY_LINE..] } else { &[] }
    }

    /// The quantity without its unit, as `display`.
    pub const fn quantity(&self) -> &'static str {
        if self.unit.is_empty() { self.name } else { self.field }
    }

    /// The value in a line.
    pub fn value(&self, line: &Telemetry) -> Option<Value> {
        (self.value)(line)
    }

    /// The value in a line as text: a number, a count or a word.
    pub fn text(&self, line: &Telemetry) -> Option<String> {
        self.value(line).map(|value| match value {
            Value::Number(number) => number.to_string(),
            Value::Count(count) => count.to_string(),
            Value::Word(word) => word.into(),
        })
    }

    /// The words of a column with words; none for one with numbers.
    pub fn words(&self) -> Vec<&'static str> {
        match self.form {
            ValueForm::Word(words) => words(),
            ValueForm::Number | ValueForm::Count => Vec::new(),
        }
    }

    /// The value in a line as a number; a word is its index in [`words`](Self::words).
    pub fn number(&self, line: &Telemetry) -> Option<f64> {
        match self.value(line)? {
            Value::Number(number) => Some(number),
            Value::Count(count) => Some(count.into()),
            Value::Word(word) => {
                let index = self.words().iter().position(|known| *known == word);
                index.map(|index| index as f64)
            }
        }
    }
}

/// What a host sends as an argument.
#[derive(Clone, Debug)]
pub enum ArgumentForm {
    /// A decimal number.
    Number(&'static Range),
    /// A whole number.
    Whole(&'static Range),
    /// Decimal numbers, one of each.
    Numbers(&'static [Range]),
    /// One of these words.
    Words(&'static [&'static str]),
    /// One or more of these words, with this between them.
    List(&'static [&'static str], &'static str),
    /// What this text says.
    Text(&'static str),
    /// It may be left out.
    Optional(Box<Self>),
}

/// A form of a line from the host.
#[derive(Clone, Copy, Debug)]
pub struct RequestForm {
    /// Words with which the line begins, each with a space behind it.
    pub words: &'static str,
    /// What it does, or asks for, as lines of text.
    pub effect: &'static [&'static str],
    /// The arguments in their order.
    pub arguments: &'static [NamedArgument],
}

/// An argument in a form of a line.
#[derive(Clone, Copy, Debug)]
pub struct NamedArgument {
    /// Its name, with the unit.
    pub name: &'static str,
    /// What it can be.
    pub form: fn() -> ArgumentForm,
}

/// A finite number.
pub fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The fault with this word.
pub fn fault(word: &str) -> Option<Fault> {
    Fault::ALL.iter().copied().find(|fault| fault.name() == word)
}

/// What is known of a finger, by its word.
pub fn knowledge(word: &str) -> Option<FingerKnowledge> {
    FingerKnowledge::ALL.into_iter().find(|known| known.name() == word)
}

/// The state with this word; a tripped one needs the word of its fault.
pub fn state(word: &str, fault_word: &str) -> Option<StateName> {
    // Every line of telemetry comes here, and the faults are many: they are searched only for a word that no other state has.
    let mut without_fault = StateName::WITHOUT_FAULT.into_iter();
    without_fault
        .find(|state| state.name() == word)
        .or_else(|| fault(fault_word).map(StateName::Tripped).filter(|state| state.name() == word))
}

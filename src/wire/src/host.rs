//! What a host needs beside the device: readers of lines, and the declarations as tables.

mod answers;
mod fields;
mod read_telemetry;
mod requests;
mod settings_line;

use std::boxed::Box;
use std::string::String;
use std::string::ToString as _;
use std::vec::Vec;

use serde::{Serialize, Serializer};
use thermal_device::StateName;
use thermal_device::safety::Fault;
use thermal_settings::{Range, Vocabulary as _};

use crate::telemetry::FIELDS_OF_EVERY_LINE;
pub use crate::telemetry::{COLUMNS, Telemetry};
pub use answers::{
    Answer, AnswerForm, Command, FieldForm, FieldRow, NamedValues, SIMULATED_UNIQUE_ID,
};
pub use fields::Fields;
pub use requests::{upload, upload_course};
pub use settings_line::SettingsLine;

/// What a word from the device can be.
#[derive(Clone, Copy, Debug)]
pub enum ValueForm {
    /// A decimal number.
    Number,
    /// A whole number, 0 or more.
    Count,
    /// A whole number, both limits included.
    CountWithin(u32, u32),
    /// One of these words.
    Word(fn() -> Vec<&'static str>),
    /// `1` or `0`.
    Bit,
    /// The first word if it is so, the second one if not.
    Whether(&'static str, &'static str),
    /// Any word.
    Text,
    /// A decimal number, or this word.
    NumberOr(&'static str),
    /// Any word; this one stands for none.
    TextOr(&'static str),
    /// Words with commas between them; this word stands for none.
    ListOr(&'static str),
    /// That, or `-` if the device does not know it.
    OrUnknown(&'static Self),
}

/// A value from the device.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A count.
    Count(u32),
    /// Whether it is so.
    Flag(bool),
    /// A word of which a host knows all.
    Word(&'static str),
    /// Another word.
    Text(String),
    /// Words.
    List(Vec<String>),
    /// There is none.
    Unknown,
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => number.serialize(serializer),
            Self::Count(count) => count.serialize(serializer),
            Self::Flag(flag) => flag.serialize(serializer),
            Self::Word(word) => word.serialize(serializer),
            Self::Text(text) => text.serialize(serializer),
            Self::List(words) => words.serialize(serializer),
            Self::Unknown => serializer.serialize_none(),
        }
    }
}

/// What a device needs to have so that its telemetry can have a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Nothing: every device has the field.
    Nothing,
    /// A heat-flux sensor.
    FluxSensor,
    /// Firmware with this capability.
    Capability(&'static str),
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
    /// What a device needs to have for it.
    pub need: Need,
    /// What its words can be.
    pub form: ValueForm,
    pub(crate) value: fn(&Telemetry) -> Option<Value>,
}

impl Column {
    /// The columns of lines in which the host has named no field: those that every device reports.
    pub fn default_ones() -> &'static [Self] {
        &COLUMNS[..FIELDS_OF_EVERY_LINE]
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
        match self.value(line)? {
            Value::Number(number) => Some(number.to_string()),
            Value::Count(count) => Some(count.to_string()),
            Value::Word(word) => Some(word.into()),
            _ => None,
        }
    }

    /// The words of a column with words; none for one with numbers.
    pub fn words(&self) -> Vec<&'static str> {
        match self.form {
            ValueForm::Word(words) => words(),
            _ => Vec::new(),
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
            _ => None,
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
    /// The type of the answer if it has values.
    pub answer: Option<&'static str>,
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

/// The state with this word; a tripped one needs the word of its fault.
pub fn state(word: &str, fault_word: &str) -> Option<StateName> {
    // Every line of telemetry comes here, and the faults are many: they are searched only for a word that no other state has.
    let mut without_fault = StateName::WITHOUT_FAULT.into_iter();
    without_fault.find(|state| state.name() == word).or_else(|| {
        Fault::of_word(fault_word).map(StateName::Tripped).filter(|state| state.name() == word)
    })
}

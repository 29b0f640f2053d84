//! Answers as a host reads them.

use std::fmt;
use std::vec::Vec;

use thermal_settings::{Person, Range};

use super::{Fields, Value, ValueForm};
use crate::UploadLine;
use crate::answer::{BoardReport, IdentifiedTile, Identity, PersonReport};

/// Names and values of an answer.
pub type NamedValues = Vec<(&'static str, Value)>;

/// What the device answers.
pub trait Answer: Sized {
    /// Name, and the word behind it, by which the device says that it has nothing to report.
    const NONE: Option<(&'static str, &'static str)>;

    /// Reads the values; `None` if one is missing or not of its kind.
    fn read(fields: &Fields<'_>) -> Option<Self>;
}

/// An answer, or `None` if the device has nothing to report.
impl<A: Answer> Answer for Option<A> {
    const NONE: Option<(&'static str, &'static str)> = A::NONE;

    fn read(fields: &Fields<'_>) -> Option<Self> {
        match A::NONE {
            Some((name, none)) if fields.word(name)? == none => Some(None),
            _ => A::read(fields).map(Some),
        }
    }
}

/// A line to the device: its `Display` is the line without the address of a finger.
pub trait Command: fmt::Display {
    /// What the device answers behind `ok`.
    type Answer: Answer;
}

/// The answer `ok` alone.
impl Answer for () {
    const NONE: Option<(&'static str, &'static str)> = None;

    fn read(fields: &Fields<'_>) -> Option<Self> {
        fields.text().is_empty().then_some(())
    }
}

impl Command for UploadLine {
    type Answer = ();
}

/// An answer with values, for tables.
#[derive(Clone, Copy, Debug)]
pub struct AnswerForm {
    /// Name of its type.
    pub name: &'static str,
    /// What it is, as lines of text.
    pub what: &'static [&'static str],
    /// Name and word of an answer without these values.
    pub none: Option<(&'static str, &'static str)>,
    /// The values in their order.
    pub rows: &'static [FieldRow],
}

/// A value of an answer, for tables.
#[derive(Clone, Copy, Debug)]
pub struct FieldRow {
    /// Name on the line.
    pub name: &'static str,
    /// Name on a host.
    pub column: &'static str,
    /// What it is.
    pub what: &'static str,
    /// What stands there.
    pub form: FieldForm,
}

/// How a value stands in an answer.
#[derive(Clone, Copy, Debug)]
pub enum FieldForm {
    /// `name=value`.
    Named(ValueForm),
    /// The same, but older firmware does not report it.
    IfReported(ValueForm),
    /// `name=` with words that have commas between them; older firmware does not report it.
    ListIfReported,
    /// The name alone, if it is so.
    NameAlone,
    /// The word with this place behind `ok`.
    WordAt(usize),
    /// `state=… fault=…`.
    StateAndFault,
    /// Decimal numbers behind these names, within these ranges.
    Numbers(fn() -> Vec<(&'static str, &'static Range)>),
}

impl Identity {
    /// Whether the firmware has this capability.
    pub fn can(&self, capability: &str) -> bool {
        self.capabilities.iter().any(|known| known == capability)
    }
}

/// First word of the unique identifier of a simulated microcontroller: a real one has its place on the wafer there.
pub const SIMULATED_UNIQUE_ID: u32 = u32::from_be_bytes(*b"SIMU");

impl BoardReport {
    /// Whether the microcontroller is a simulated one, as its unique identifier says, whatever line leads to it.
    pub fn is_simulated(&self) -> bool {
        let word = self.uid.as_deref().and_then(|uid| uid.get(..8));
        word.is_some_and(|word| u32::from_str_radix(word, 16) == Ok(SIMULATED_UNIQUE_ID))
    }
}

impl PersonReport {
    /// The chosen or enrolled person; `None` for an unknown one.
    pub fn person(&self) -> Option<Person> {
        let (code, data) = self.code.zip(self.data)?;
        Some(Person { code, finger: data.0 })
    }
}

impl fmt::Display for IdentifiedTile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "gain {:.3} K/s/A, Joule {:.4} 1/A, leak {:.3} 1/s, lag {:.1} ms, dead time {:.1} ms; margins {:.1} deg, {:.2} times",
            self.gain_k_s_a,
            self.joule_per_a,
            self.leak_1_s,
            1e3 * self.lag_s,
            1e3 * self.dead_s,
            self.phase_deg,
            self.gain_margin
        )
    }
}

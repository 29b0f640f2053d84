//! Answers about persons.

use thermal_settings::{Person, PersonCode, Persons};

use crate::LineBuffer;
use crate::kind::NOBODY_WORD;

/// A person in the answers to `person` and `person enrol`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonReply {
    /// The chosen one, or the one that was stored.
    pub person: Option<Person>,
    /// Contacts of 8 s or more, trusted to their end, since the person was chosen or the finger was last distrusted.
    pub contacts: u8,
}

/// The codes of all persons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PersonCodes(heapless::Vec<PersonCode, { Persons::MAX }>);

impl PersonCodes {
    /// The codes of these persons, in their order.
    pub fn new(persons: &Persons) -> Self {
        let mut codes = heapless::Vec::new();
        for person in persons.as_slice() {
            // There is room for all persons.
            let _fits = codes.push(person.code);
        }
        Self(codes)
    }
}

impl PersonCodes {
    /// Appends the codes with commas; `none` without any.
    pub(crate) fn write(&self, line: &mut LineBuffer) {
        let mut separator = "";
        for code in &self.0 {
            line.push_str_if_fits(separator);
            line.push_person_code(*code);
            separator = ",";
        }
        if self.0.is_empty() {
            line.push_str_if_fits(NOBODY_WORD);
        }
    }
}

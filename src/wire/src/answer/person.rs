//! Answers about persons.

use core::fmt;

use thermal_settings::{Person, PersonCode, Persons};

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
    /// Those of these persons.
    pub fn new(persons: &Persons) -> Self {
        let mut codes = heapless::Vec::new();
        for person in persons.as_slice() {
            // There is room for all persons.
            let _fits = codes.push(person.code);
        }
        Self(codes)
    }
}

/// Writes the codes with commas; `none` without any.
impl fmt::Display for PersonCodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str(NOBODY_WORD);
        }
        for (index, code) in self.0.iter().enumerate() {
            f.write_str(if index > 0 { "," } else { "" })?;
            code.fmt(f)?;
        }
        Ok(())
    }
}

//! The commands `person`, `persons` and `forget person`: parsing, and answers.

use core::fmt;

use thermal_commissioning::StorageOrder;
use thermal_settings::{Person, PersonCode, Persons};

use crate::arguments::{Words, skip_if_next_is, word_or_empty};
use crate::line_checksum::TwoHexDigits;
use crate::{Error, Request};

/// Contacts of 8 s or more from which a finger must have been learnt to be stored by `person enrol`.
pub const ENROL_CONTACTS: u8 = 2;

/// Order about persons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PersonRequest {
    /// The line `person`: report the chosen person, and from how many contacts the finger is learnt.
    Query,
    /// The line `person CODE` or `person none`: begin to learn with this person, or an unknown one.
    Choose(Option<PersonCode>),
    /// The line `person CODE DATA`: store the person.
    Store(Person),
    /// The line `person enrol CODE`: store what was learnt.
    Enrol(PersonCode),
    /// The line `persons`: report all.
    List,
    /// The line `forget person CODE`: forget the person.
    Forget(PersonCode),
}

/// Reads the arguments of the command `person`.
#[inline(never)]
pub fn parse_person(words: &mut Words<'_>) -> Result<Request, Error> {
    Ok(Request::Person(match word_or_empty(words) {
        "" => PersonRequest::Query,
        "none" => PersonRequest::Choose(None),
        "enrol" => PersonRequest::Enrol(code(word_or_empty(words))?),
        word => {
            let code = code(word)?;
            match words.next() {
                None => PersonRequest::Choose(Some(code)),
                Some(data) => PersonRequest::Store(Person {
                    code,
                    finger: Person::read_finger(data).ok_or(Error::NotPersonData(data.into()))?,
                }),
            }
        }
    }))
}

/// Reads the arguments of the command `forget`: `person` and a code, or nothing for all that is stored.
#[inline(never)]
pub fn parse_forget(words: &mut Words<'_>) -> Result<Request, Error> {
    Ok(if skip_if_next_is(words, "person") {
        Request::Person(PersonRequest::Forget(code(word_or_empty(words))?))
    } else {
        Request::Storage(StorageOrder::Forget)
    })
}

fn code(word: &str) -> Result<PersonCode, Error> {
    PersonCode::new(word).ok_or(Error::NotPersonCode(word.into()))
}

/// A person in the answers to `person` and `person enrol`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonReply {
    /// The chosen one, or the one that was stored.
    pub person: Option<Person>,
    /// Contacts of 8 s or more, trusted to their end, since the person was chosen or the finger was last distrusted.
    pub contacts: u8,
}

impl fmt::Display for PersonReply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(person) = &self.person else {
            return write!(f, "ok person=none contacts={}", self.contacts);
        };
        write!(f, "ok person={} contacts={} data=", person.code, self.contacts)?;
        for byte in person.finger {
            TwoHexDigits(byte).fmt(f)?;
        }
        Ok(())
    }
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
            return f.write_str("none");
        }
        for (index, code) in self.0.iter().enumerate() {
            f.write_str(if index > 0 { "," } else { "" })?;
            code.fmt(f)?;
        }
        Ok(())
    }
}

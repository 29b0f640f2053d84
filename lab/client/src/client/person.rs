//! Persons whose fingers a device has learnt.

use std::fmt;

use thermal_settings::{Person, PersonCode};
use thermal_wire::request::PersonRequest;

use super::{Command, Fields};

/// Answer to `person` and `person enrol`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonReport {
    /// The chosen or enrolled person; `None` for an unknown one.
    pub person: Option<Person>,
    /// Contacts of 8 s or more, trusted to their end, since the person was chosen or the finger was last distrusted.
    pub contacts: u8,
}

impl PersonReport {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        let person = match reply.word("person")? {
            "none" => None,
            word => Some(Person {
                code: PersonCode::new(word)?,
                finger: Person::read_finger(reply.word("data")?)?,
            }),
        };
        Some(Self { person, contacts: reply.number("contacts")? })
    }
}

/// Stores what was learnt of the finger as that of a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnrolPerson(pub PersonCode);

impl fmt::Display for EnrolPerson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        PersonRequest::Enrol { code: self.0 }.fmt(f)
    }
}

impl Command for EnrolPerson {
    type Reply = PersonReport;

    fn read_reply(&self, reply: &Fields<'_>) -> Option<PersonReport> {
        PersonReport::read(reply)
    }
}

/// The codes of an answer to `persons`.
pub(super) fn read_codes(reply: &Fields<'_>) -> Option<Vec<PersonCode>> {
    match reply.word("persons")? {
        "none" => Some(Vec::new()),
        codes => codes.split(',').map(PersonCode::new).collect(),
    }
}

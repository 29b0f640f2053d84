//! Persons whose fingers were learnt, for all fingers of a device.

use core::fmt::{self, Write as _};

use heapless::Vec;

/// Stands for a person: 1 to 8 characters of A-Z and 0-9. The host chooses it; it must not be a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PersonCode([u8; Self::MAX_BYTES]);

impl PersonCode {
    /// Length of the longest code, and of each code in a record, where zeros follow shorter ones.
    pub const MAX_BYTES: usize = 8;

    /// The code that is this word; `None` if it is none.
    pub fn new(word: &str) -> Option<Self> {
        let mut padded = [0; Self::MAX_BYTES];
        let places = padded.get_mut(..word.len())?;
        for (place, byte) in places.iter_mut().zip(word.bytes()) {
            *place = byte;
        }
        Self::from_bytes(padded)
    }

    /// The code from a record; `None` if it is none.
    pub fn from_bytes(bytes: [u8; Self::MAX_BYTES]) -> Option<Self> {
        let mut characters = bytes.iter().skip_while(|byte| is_of_code(**byte));
        (is_of_code(bytes[0]) && characters.all(|byte| *byte == 0)).then_some(Self(bytes))
    }

    /// The code in a record.
    pub const fn to_bytes(self) -> [u8; Self::MAX_BYTES] {
        self.0
    }
}

impl fmt::Display for PersonCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut characters = self.0.into_iter().take_while(|byte| *byte != 0);
        characters.try_for_each(|byte| f.write_char(char::from(byte)))
    }
}

const fn is_of_code(byte: u8) -> bool {
    byte.is_ascii_uppercase() || byte.is_ascii_digit()
}

/// What is stored of a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Person {
    /// Stands for the person.
    pub code: PersonCode,
    /// What was learnt of the person's finger, as `thermal-learner` has it. Any bytes are allowed.
    pub finger: [u8; Self::FINGER_BYTES],
}

impl Person {
    /// Length of what was learnt of a finger.
    pub const FINGER_BYTES: usize = 20;
    /// Length of a person in a record.
    pub const BYTES: usize = PersonCode::MAX_BYTES + Self::FINGER_BYTES;

    /// Reads what was learnt of a finger: two hexadecimal digits for each byte; `None` for anything else.
    pub fn read_finger(digits: &str) -> Option<[u8; Self::FINGER_BYTES]> {
        let mut finger = [0; Self::FINGER_BYTES];
        let (pairs, _) = digits.as_bytes().as_chunks::<2>();
        if digits.len() != 2 * finger.len() {
            return None;
        }
        for (byte, [high, low]) in finger.iter_mut().zip(pairs) {
            let digit = |digit: u8| char::from(digit).to_digit(16);
            *byte = (digit(*high)? << 4 | digit(*low)?) as u8;
        }
        Some(finger)
    }
}

/// The persons of a device, each with a code of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Persons(Vec<Person, { Self::MAX }>);

impl Persons {
    /// Largest number of persons.
    pub const MAX: usize = 16;

    /// None.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// All, in the order in which they were stored.
    pub fn as_slice(&self) -> &[Person] {
        &self.0
    }

    /// The person with this code.
    pub fn get(&self, code: PersonCode) -> Option<&Person> {
        self.0.iter().find(|person| person.code == code)
    }

    /// Stores a person, in place of the one with the same code if there is one. Returns whether there was room.
    pub fn insert(&mut self, person: Person) -> bool {
        match self.0.iter_mut().find(|other| other.code == person.code) {
            Some(place) => {
                *place = person;
                true
            }
            None => self.0.push(person).is_ok(),
        }
    }

    /// Forgets the person with this code. Returns whether there was one.
    pub fn remove(&mut self, code: PersonCode) -> bool {
        let before = self.0.len();
        self.0.retain(|person| person.code != code);
        self.0.len() < before
    }
}

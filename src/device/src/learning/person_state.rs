//! The person whose finger touches, and what was learnt of it.

use thermal_learner::{PersonPrior, Trust};
use thermal_settings::Person;

/// What is known of the person.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PersonState {
    /// The person whom the host has chosen, with whose finger the learner has begun.
    pub chosen: Option<Person>,
    /// What can be stored of the finger that was learnt since the learner has begun; `None` before the first contact that is
    /// long enough, and after a distrust.
    pub learnt: Option<PersonPrior>,
}

impl PersonState {
    /// Before the first contact.
    pub const fn new(chosen: Option<Person>) -> Self {
        Self { chosen, learnt: None }
    }

    /// The finger with which the learner begins.
    pub fn prior(&self) -> Option<PersonPrior> {
        self.chosen.map(|person| PersonPrior(person.finger))
    }

    /// Contacts from which what can be stored was learnt.
    pub fn contacts(&self) -> u8 {
        self.learnt.map_or(0, |learnt| learnt.contacts())
    }

    /// Notes what the learner says of the finger: its trust, and what can be stored.
    pub fn note(&mut self, trust: Trust, learnt: Option<&PersonPrior>) {
        if matches!(trust, Trust::Mean(_)) {
            self.learnt = None;
        }
        if let Some(learnt) = learnt {
            self.learnt = Some(*learnt);
        }
    }
}

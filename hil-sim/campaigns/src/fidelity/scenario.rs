//! The scenarios.

use contact_model::pressure::STATED;

use super::case::ROOM_C;
use super::things::UNSEEN;
use super::{Case, Measure, Press, Thing};

/// What a finger does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scenario {
    /// A finger lands on the preset display and stays for 10 s.
    #[serde(rename = "A")]
    A,
    /// An object appears under a finger that rests on the neutral display.
    #[serde(rename = "B")]
    B,
    /// Lift and replace: 1 s on, 1 s off, ten times.
    #[serde(rename = "C")]
    C,
    /// The force rises and falls during contact.
    #[serde(rename = "D")]
    D,
    /// Materials by their properties, warm objects, other skin; one object too warm to be shown.
    Unseen,
}

/// The usual skin, °C.
const SKIN_C: f64 = 34.0;
/// Four materials from good to bad conductor.
const FOUR: [&str; 4] = ["copper", "granite", "abs", "foam"];
/// The thesis's largest force, N.
const PRESSED_N: f64 = 2.0;

impl Scenario {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::A, Self::B, Self::C, Self::D, Self::Unseen];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
            Self::D => "D",
            Self::Unseen => "unseen",
        }
    }

    /// What happens in it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::A => "a finger lands on the preset display and stays for 10 s",
            Self::B => "an object appears under a finger that rests on the neutral display",
            Self::C => "lift and replace, 1 s on, 1 s off, ten times",
            Self::D => "0.1 N, up to 2 N within 1 s, and back",
            Self::Unseen => "materials by their properties, warm objects, other skin; as A",
        }
    }

    /// Its scenes.
    #[must_use]
    pub fn cases(self) -> Vec<Case> {
        match self {
            Self::A => each_force(|thing, force_n| self.lands(thing, force_n)),
            Self::B => each_force(|thing, force_n| self.appears(thing, force_n)),
            Self::C => each_force(|thing, force_n| self.replaced(thing, force_n)),
            Self::D => Thing::thesis().map(|thing| self.ramped(thing)).collect(),
            Self::Unseen => self.unseen(),
        }
    }

    fn case(
        self,
        thing: Thing,
        force_n: f64,
        duration_s: f64,
        presses: &[(f64, f64, f64)],
    ) -> Case {
        Case {
            scenario: self,
            name: thing.name.into(),
            thing,
            force_n,
            skin_c: SKIN_C,
            object_c: ROOM_C,
            appears_t_s: 0.0,
            presses: (presses.iter())
                .map(|&(t_s, force_n, ramp_s)| Press {
                    t_s,
                    force_n,
                    ramp_s,
                })
                .collect(),
            duration_s,
            measure: Measure::LANDING,
        }
    }

    fn lands(self, thing: Thing, force_n: f64) -> Case {
        self.case(thing, force_n, 11.0, &[(1.0, force_n, 0.0)])
    }

    /// Bounds are stated for three of the materials.
    fn appears(self, thing: Thing, force_n: f64) -> Case {
        let bound_s = match thing.name {
            "copper" => Some(1.25),
            "abs" => Some(0.35),
            "foam" => Some(0.1),
            _ => None,
        };
        Case {
            appears_t_s: 2.0,
            measure: Measure::Settles {
                below_mk: 50.0,
                bound_s,
            },
            ..self.case(thing, force_n, 12.0, &[(0.5, force_n, 0.0)])
        }
    }

    fn replaced(self, thing: Thing, force_n: f64) -> Case {
        let on_and_off = |i: u32| {
            let t_s = f64::from(2 * i + 1);
            [(t_s, force_n, 0.0), (t_s + 1.0, 0.0, 0.0)]
        };
        let presses: Vec<_> = (0..10).flat_map(on_and_off).collect();
        Case {
            measure: Measure::CHANGING,
            ..self.case(thing, force_n, 21.0, &presses)
        }
    }

    fn ramped(self, thing: Thing) -> Case {
        let presses = [(1.0, 0.1, 0.0), (2.0, PRESSED_N, 1.0), (5.0, 0.1, 1.0)];
        Case {
            measure: Measure::CHANGING,
            ..self.case(thing, PRESSED_N, 8.0, &presses)
        }
    }

    fn unseen(self) -> Vec<Case> {
        let mut cases = Vec::new();
        for thing in UNSEEN {
            cases.extend(STATED.map(|(force_n, _)| self.lands(thing, force_n)));
        }
        for thing in FOUR.map(Thing::known) {
            cases.push(Case {
                name: format!("{} of 41 C", thing.name),
                object_c: 41.0,
                ..self.lands(thing, PRESSED_N)
            });
        }
        for skin_c in [28.0, 31.0, 36.0] {
            cases.extend(FOUR.map(Thing::known).map(|thing| Case {
                name: format!("{}, skin {skin_c} C", thing.name),
                skin_c,
                ..self.lands(thing, PRESSED_N)
            }));
        }
        cases.push(Case {
            name: "copper of 44 C".into(),
            object_c: 44.0,
            measure: Measure::Limited,
            ..self.lands(Thing::known("copper"), PRESSED_N)
        });
        cases
    }
}

/// The thesis's materials at its five forces.
fn each_force(case: impl Fn(Thing, f64) -> Case) -> Vec<Case> {
    let case = &case;
    Thing::thesis()
        .flat_map(|thing| STATED.map(move |(force_n, _)| case(thing, force_n)))
        .collect()
}

#[cfg(test)]
mod tests;

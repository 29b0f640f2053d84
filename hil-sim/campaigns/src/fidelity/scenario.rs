//! Scenarios: series of cases.

use contact_model::pressure::THESIS_PRESSURES;
use thermal_sim::named_enum;
use thermal_sim::scene::Force;

use super::case::ROOM_C;
use super::touched_object::UNKNOWN_MATERIALS;
use super::{FidelityCase, Measure, TouchedObject};

named_enum! {
    /// A scenario of contact.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
    pub enum Scenario {
        /// A finger lands on the preset display and stays for 10 s.
        A = "A",
        /// An object appears under a finger that rests on the neutral display.
        B = "B",
        /// Lift and replace: 1 s on, 1 s off, ten times.
        C = "C",
        /// The force rises and falls during contact.
        D = "D",
        /// Materials by their properties, warm objects, other skin; one object too warm to be shown.
        #[serde(rename = "unseen")]
        Unseen = "unseen",
    }
}

/// Skin temperature of most cases, °C.
const SKIN_C: f64 = 34.0;
/// Four materials from good to bad conductor.
const FOUR: [&str; 4] = ["copper", "granite", "abs", "foam"];
/// The thesis's largest force, N.
const PRESSED_N: f64 = 2.0;

impl Scenario {
    /// Description of the scenario.
    pub const fn title(self) -> &'static str {
        match self {
            Self::A => "a finger lands on the preset display and stays for 10 s",
            Self::B => "an object appears under a finger that rests on the neutral display",
            Self::C => "lift and replace, 1 s on, 1 s off, ten times",
            Self::D => "0.1 N, up to 2 N within 1 s, and back",
            Self::Unseen => "materials by their properties, warm objects, other skin; as A",
        }
    }

    /// The cases of the scenario.
    pub fn cases(self) -> Vec<FidelityCase> {
        match self {
            Self::A => each_force(|object, force_n| self.lands(object, force_n)),
            Self::B => each_force(|object, force_n| self.appears(object, force_n)),
            Self::C => each_force(|object, force_n| self.replaced(object, force_n)),
            Self::D => TouchedObject::thesis().map(|object| self.ramped(object)).collect(),
            Self::Unseen => self.unseen(),
        }
    }

    fn case(
        self,
        object: TouchedObject,
        force_n: f64,
        duration_s: f64,
        forces: &[(f64, f64, f64)],
    ) -> FidelityCase {
        FidelityCase {
            scenario: self,
            name: object.name.into(),
            object,
            force_n,
            skin_c: SKIN_C,
            object_c: ROOM_C,
            appears_t_s: 0.0,
            forces: (forces.iter())
                .map(|&(t_s, force_n, ramp_s)| Force { t_s, force_n, ramp_s })
                .collect(),
            duration_s,
            measure: Measure::LANDING,
        }
    }

    fn lands(self, object: TouchedObject, force_n: f64) -> FidelityCase {
        self.case(object, force_n, 11.0, &[(1.0, force_n, 0.0)])
    }

    /// Bounds are stated for three of the materials.
    fn appears(self, object: TouchedObject, force_n: f64) -> FidelityCase {
        let bound_s = match object.name {
            "copper" => Some(1.25),
            "abs" => Some(0.35),
            "foam" => Some(0.1),
            _ => None,
        };
        FidelityCase {
            appears_t_s: 2.0,
            measure: Measure::Settles { below_mk: 50.0, bound_s },
            ..self.case(object, force_n, 12.0, &[(0.5, force_n, 0.0)])
        }
    }

    fn replaced(self, object: TouchedObject, force_n: f64) -> FidelityCase {
        let on_and_off = |i: u32| {
            let t_s = f64::from(2 * i + 1);
            [(t_s, force_n, 0.0), (t_s + 1.0, 0.0, 0.0)]
        };
        let forces: Vec<_> = (0..10).flat_map(on_and_off).collect();
        FidelityCase { measure: Measure::CHANGING, ..self.case(object, force_n, 21.0, &forces) }
    }

    fn ramped(self, object: TouchedObject) -> FidelityCase {
        let forces = [(1.0, 0.1, 0.0), (2.0, PRESSED_N, 1.0), (5.0, 0.1, 1.0)];
        FidelityCase { measure: Measure::CHANGING, ..self.case(object, PRESSED_N, 8.0, &forces) }
    }

    fn unseen(self) -> Vec<FidelityCase> {
        let mut cases = Vec::new();
        for object in UNKNOWN_MATERIALS {
            cases.extend(THESIS_PRESSURES.map(|(force_n, _)| self.lands(object, force_n)));
        }
        for object in FOUR.map(TouchedObject::of_thesis) {
            cases.push(FidelityCase {
                name: format!("{} of 41 C", object.name),
                object_c: 41.0,
                ..self.lands(object, PRESSED_N)
            });
        }
        for skin_c in [28.0, 31.0, 36.0] {
            cases.extend(FOUR.map(TouchedObject::of_thesis).map(|object| FidelityCase {
                name: format!("{}, skin {skin_c} C", object.name),
                skin_c,
                ..self.lands(object, PRESSED_N)
            }));
        }
        cases.push(FidelityCase {
            name: "copper of 44 C".into(),
            object_c: 44.0,
            measure: Measure::Limited,
            ..self.lands(TouchedObject::of_thesis("copper"), PRESSED_N)
        });
        cases
    }
}

/// The thesis's materials at its five forces.
fn each_force(case: impl Fn(TouchedObject, f64) -> FidelityCase) -> Vec<FidelityCase> {
    let case = &case;
    TouchedObject::thesis()
        .flat_map(|object| THESIS_PRESSURES.map(move |(force_n, _)| case(object, force_n)))
        .collect()
}

#[cfg(test)]
mod tests;

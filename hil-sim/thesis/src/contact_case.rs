//! Contacts of the thesis, and their closed-form solution.

use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::reference::{Contact, SemiInfinite};

/// Force of the simulation of section 6.3, N.
const SIMULATION_FORCE_N: f64 = 2.0;
/// Area of section 6.3, m² (measured in section 4.4).
pub(super) const SIMULATION_AREA_M2: f64 = 135e-6;
/// Pressure of the simulation of section 6.3, Pa.
pub(super) const SIMULATION_PRESSURE_PA: f64 = SIMULATION_FORCE_N / SIMULATION_AREA_M2;

/// A material with the name that the thesis uses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub name: &'static str,
    pub material: Material,
}

/// A material by the name that the thesis gives it.
pub(super) fn material(name: &str) -> Material {
    let key = name.to_lowercase().replace(' ', "-");
    let found = match key.as_str() {
        "skin" => Some(&SKIN),
        key => find(key),
    };
    *found.unwrap_or_else(|| panic!("{name:?} is no material of the model"))
}

pub(super) fn sample(name: &'static str) -> Sample {
    Sample { name, material: material(name) }
}

/// The five materials of chapters 4 and 6 in order of decreasing contact coefficient.
pub(super) fn five_materials() -> [Sample; 5] {
    ["copper", "stainless steel", "granite", "ABS", "foam"].map(sample)
}

/// The contact coefficient as printed in Tables 3-1, 3-4 and 4-1: truncated to an integer.
pub(super) fn tabulated_effusivity(material: &Material) -> f64 {
    super::stated_value::cut(material.effusivity(), 0)
}

/// Contact of a finger with an object from time zero on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Material of the object.
    pub object: Material,
    /// Skin temperature before contact, °C.
    pub skin_c: f64,
    /// Object temperature before contact, °C.
    pub object_c: f64,
    /// Contact pressure, Pa.
    pub pressure_pa: f64,
}

impl Case {
    /// Section 6.3: 34 and 24 °C, 2 N on 135 mm².
    pub(super) fn simulation(object: Material) -> Self {
        Self { object, skin_c: 34.0, object_c: 24.0, pressure_pa: SIMULATION_PRESSURE_PA }
    }

    /// Section 6.4: 34 and 26 °C at one of the measured pressures.
    pub(super) fn validation(object: Material, pressure_pa: f64) -> Self {
        Self { object, skin_c: 34.0, object_c: 26.0, pressure_pa }
    }

    /// The contact by Eq. 6-5 to 6-12, reproduced on the reference display.
    pub(super) fn contact(&self) -> Contact<f64> {
        Contact::new(
            (&SKIN, self.skin_c),
            (&self.object, self.object_c),
            &REFERENCE_DISPLAY,
            self.pressure_pa,
        )
    }

    /// The same contact without contact resistance, Eq. 3-1 to 3-3.
    pub(super) fn perfect(&self) -> SemiInfinite<f64> {
        SemiInfinite::new((&SKIN, self.skin_c), (&self.object, self.object_c))
    }

    /// Drop of the skin temperature, K, `t_s` seconds after the start of contact.
    pub(super) fn drop_k(&self, t_s: f64) -> f64 {
        self.skin_c - self.contact().at(t_s).skin_c
    }
}

/// Surface temperatures and heat flux at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surfaces {
    /// Skin surface, °C.
    pub skin_c: f64,
    /// Object surface, °C.
    pub object_c: f64,
    /// Surface of the reference display that gives the same skin temperature, °C.
    pub display_c: f64,
    /// Heat flux out of the skin, W/m².
    pub flux_w_m2: f64,
}

/// A method that solves a contact over time.
pub trait ContactSolver {
    /// The surfaces at each of `times_s`, s after the start of contact, in increasing order.
    ///
    /// # Errors
    /// The case cannot be computed.
    fn solve(&self, case: &Case, times_s: &[f64]) -> anyhow::Result<Vec<Surfaces>>;
}

/// Closed-form solution, Eq. 6-5 to 6-7 and 6-12.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm;

impl ContactSolver for ClosedForm {
    fn solve(&self, case: &Case, times_s: &[f64]) -> anyhow::Result<Vec<Surfaces>> {
        let contact = case.contact();
        let surfaces = times_s.iter().map(|&t_s| {
            let at = contact.at(t_s);
            Surfaces {
                skin_c: at.skin_c,
                object_c: at.object_c,
                display_c: at.display_c,
                flux_w_m2: at.flux_w_m2,
            }
        });
        Ok(surfaces.collect())
    }
}

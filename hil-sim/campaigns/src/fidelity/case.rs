//! Cases: the scenes of a scenario.

use std::fmt::Write;
use std::path::PathBuf;

use contact_model::material::Surface;
use thermal_device::control::Law;
use thermal_sim::scene::{Force, Scene, SceneError};

use super::{Measure, Scenario, TouchedObject};

/// A scene of a scenario, for any control law and plant.
#[derive(Clone, Debug, PartialEq)]
pub struct FidelityCase {
    /// The scenario that it belongs to.
    pub scenario: Scenario,
    /// Name: the material and what is special about the case.
    pub name: String,
    /// The touched object.
    pub object: TouchedObject,
    /// Largest force, N.
    pub force_n: f64,
    /// Skin temperature before contact, °C.
    pub skin_c: f64,
    /// Object temperature before contact, °C.
    pub object_c: f64,
    /// Time at which the object appears, s.
    pub appears_t_s: f64,
    /// Changes of the force.
    pub forces: Vec<Force>,
    /// Duration, s.
    pub duration_s: f64,
    /// The figure that is compared with a bound.
    pub measure: Measure,
}

/// Room temperature of all cases, °C.
pub const ROOM_C: f64 = 24.0;

/// Warmest object that a scene file may name under a finger of 34 °C: the device's safe range.
const WARMEST_C: f64 = 42.0;

impl FidelityCase {
    /// The text of the scene; `plant` has plant parameters that are not nominal.
    pub fn text(&self, law: Law, seed: u64, plant: &[(String, f64)]) -> String {
        let mut text = format!(
            "duration_s = {:?}\nskin_c = {:?}\nroom_c = {ROOM_C:?}\nseed = {seed}\nlaw = \"{}\"\n[object]\n",
            self.duration_s,
            self.skin_c,
            law.name()
        );
        // Writing to a String cannot fail.
        let _ = match self.object.properties {
            None => writeln!(text, "material = \"{}\"", self.object.name),
            Some(material) => {
                let Surface { conductivity_w_mk, roughness_um, slope_rad } = material.surface;
                let (density, heat) = (material.density_kg_m3, material.specific_heat_j_kgk);
                writeln!(
                    text,
                    "k_w_mk = {conductivity_w_mk:?}\nrho_kg_m3 = {density:?}\nc_j_kgk = {heat:?}\nrq_um = \
                     {roughness_um:?}\nslope_rad = {slope_rad:?}"
                )
            }
        };
        let start_c = self.object_c.min(WARMEST_C);
        let _ = writeln!(text, "start_c = {start_c:?}\nappears_t_s = {:?}", self.appears_t_s);
        for Force { t_s, force_n, ramp_s } in &self.forces {
            let _ = writeln!(
                text,
                "[[force]]\nt_s = {t_s:?}\nforce_n = {force_n:?}\nramp_s = {ramp_s:?}"
            );
        }
        if !plant.is_empty() {
            text += "[plant]\n";
        }
        for (key, value) in plant {
            let _ = writeln!(text, "{key} = {value:?}");
        }
        text
    }

    /// The scene. An object temperature beyond the safe range, which a scene file cannot have, is set afterwards.
    ///
    /// # Errors
    /// A plant parameter is unknown or out of range.
    pub fn scene(&self, law: Law, seed: u64, plant: &[(String, f64)]) -> Result<Scene, SceneError> {
        let name = format!("{} {} {} N", self.scenario.name(), self.name, self.force_n);
        let mut scene = Scene::parse(&self.text(law, seed, plant), &PathBuf::from(name))?;
        scene.object.start_c = Some(self.object_c);
        Ok(scene)
    }
}

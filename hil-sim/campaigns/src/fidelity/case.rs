//! One scene of a scenario.

use std::fmt::Write;
use std::path::PathBuf;

use contact_model::material::Surface;
use thermal_device::control::Law;
use thermal_sim::scene::{Force, Scene, SceneError};

use super::{Measure, Scenario, TouchedObject};

/// One scene, for any law and plant.
#[derive(Clone, Debug, PartialEq)]
pub struct FidelityCase {
    /// The scenario that it belongs to.
    pub scenario: Scenario,
    /// What it is: the material, and what is unusual.
    pub name: String,
    /// What the finger feels.
    pub object: TouchedObject,
    /// Largest force, N.
    pub force_n: f64,
    /// Skin before contact, °C.
    pub skin_c: f64,
    /// The object before contact, °C.
    pub object_c: f64,
    /// When it appears, s.
    pub appears_t_s: f64,
    /// The finger.
    pub presses: Vec<Force>,
    /// Length, s.
    pub duration_s: f64,
    /// What is judged.
    pub measure: Measure,
}

/// Room of all cases, °C.
pub const ROOM_C: f64 = 24.0;

/// Warmest object that a scene file may name under a finger of 34 °C: the device's safe range.
const WARMEST_C: f64 = 42.0;

impl FidelityCase {
    /// The scene as a file has it; `plant` are keys of the parameter box.
    #[must_use]
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
                let Surface {
                    conductivity_w_mk,
                    roughness_um,
                    slope_rad,
                } = material.surface;
                let (density, heat) = (material.density_kg_m3, material.specific_heat_j_kgk);
                writeln!(
                    text,
                    "k_w_mk = {conductivity_w_mk:?}\nrho_kg_m3 = {density:?}\nc_j_kgk = {heat:?}\nrq_um = \
                     {roughness_um:?}\nslope_rad = {slope_rad:?}"
                )
            }
        };
        let start_c = self.object_c.min(WARMEST_C);
        let _ = writeln!(
            text,
            "start_c = {start_c:?}\nappears_t_s = {:?}",
            self.appears_t_s
        );
        for Force {
            t_s,
            force_n,
            ramp_s,
        } in &self.presses
        {
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

    /// The scene. An object outside of the safe range, which no scene file may name, is put in afterwards.
    ///
    /// # Errors
    /// A plant key or value that is not possible.
    pub fn scene(&self, law: Law, seed: u64, plant: &[(String, f64)]) -> Result<Scene, SceneError> {
        let name = format!("{} {} {} N", self.scenario.name(), self.name, self.force_n);
        let mut scene = Scene::parse(&self.text(law, seed, plant), &PathBuf::from(name))?;
        scene.object.start_c = Some(self.object_c);
        Ok(scene)
    }
}

//! A case of a population: the scene and its run.

use std::path::Path;

use thermal_sim::metrics::skin_errors;
use thermal_sim::scene::{Scene, SceneError};
use thermal_sim::{SceneRunner, named_enum};

use super::super::case::ROOM_C;
use super::{BodyObject, Population, PopulationResult, Since};

named_enum! {
    /// What the device is told of object and finger.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Way {
        /// The object as it is, and a finger like the one that touches: the thesis's, or the mean layered one, in air or on
        /// a pad before contact.
        AsItIs = "as-it-is",
        /// A half-space of the touched material, and the thesis's finger.
        #[serde(rename = "version-0.1")]
        Version01 = "version-0.1",
    }
}

/// One object under one finger on one device.
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationCase {
    /// The population that it belongs to.
    pub population: Population,
    /// Its name: the object, and the number of the draw if there is one.
    pub name: String,
    /// The touched object.
    pub object: BodyObject,
    /// Seed of the converter.
    pub seed: u64,
    /// Tables of the scene for finger and plant.
    pub tables: String,
}

impl PopulationCase {
    /// Force of all cases, N.
    pub const FORCE_N: f64 = 2.0;

    /// The text of the scene: scenario A with 2 N.
    pub fn text(&self, way: Way) -> String {
        let (told, assumed) = match way {
            Way::AsItIs => ("", ""),
            Way::Version01 => ("told = \"half-space\"\n", "finger = \"thesis\"\n"),
        };
        let sensor = match self.population {
            // The maker of a display with such a sensor also measures its surface.
            Population::DesignedSensor | Population::HypotheticalSensor => {
                "flux_sensor = true\nmeasured_surface = true\n"
            }
            Population::KnownSurfaces => "flux_sensor = true\n",
            Population::EnrolledDesigned | Population::EnrolledHypothetical => {
                "flux_sensor = true\nmeasured_surface = true\nenrolled = true\n"
            }
            _ => "",
        };
        let Self { object: BodyObject { material, keys, .. }, seed, tables, .. } = self;
        format!(
            "duration_s = 11.0\nskin_c = 34.0\nroom_c = {ROOM_C:?}\nseed = {seed}\n[object]\nmaterial = \
             \"{material}\"\nstart_c = {ROOM_C:?}\n{told}{keys}[device]\n{assumed}{sensor}{tables}[[force]]\nt_s = 1.0\nforce_n = {:?}\n",
            Self::FORCE_N
        )
    }

    /// The scene.
    ///
    /// # Errors
    /// The drawn plant contradicts itself.
    pub fn scene(&self, way: Way) -> Result<Scene, SceneError> {
        let name = format!("{} {} {}", self.population.name(), self.name, way.name());
        Scene::parse(&self.text(way), Path::new(&name))
    }

    /// Runs the scene.
    ///
    /// # Errors
    /// The device stopped, or refused the scene.
    pub fn run(&self, device: &dyn SceneRunner, way: Way) -> anyhow::Result<PopulationResult> {
        let scene = self.scene(way)?;
        let (outcome, figures) = device.run(&scene)?;
        let late =
            skin_errors(&scene, &outcome).filter(|(since_s, _)| *since_s >= Since::Ms500.since_s());
        let late_mk = late.map(|(_, error_k)| 1e3 * error_k.abs());
        let skin = figures.skin_error_mk.unwrap_or_default();
        Ok(PopulationResult {
            population: self.population,
            case: self.name.clone(),
            way,
            max_after_50ms_mk: skin.max_after_50ms.unwrap_or(f64::INFINITY),
            max_after_500ms_mk: late_mk.reduce(f64::max).unwrap_or(f64::INFINITY),
            rms_mk: skin.rms,
            is_enrolled: (outcome.exchanges().iter())
                .any(|exchange| exchange.line.is_some_and(|line| line.starts_with("person "))),
            faults: figures.faults.into_iter().map(|trip| trip.fault).collect(),
        })
    }

    /// Checks that two engines write the same trace, byte for byte.
    ///
    /// # Errors
    /// They do not, or a run failed.
    pub fn check_same(
        &self,
        one: &dyn SceneRunner,
        other: &dyn SceneRunner,
        way: Way,
    ) -> anyhow::Result<()> {
        let scene = self.scene(way)?;
        let trace = |engine: &dyn SceneRunner| -> anyhow::Result<Vec<u8>> {
            let (outcome, _) = engine.run(&scene)?;
            let mut text = Vec::new();
            outcome.trace.write_to(&mut text)?;
            Ok(text)
        };
        anyhow::ensure!(
            trace(one)? == trace(other)?,
            "the engines {} and {} write different traces",
            one.name(),
            other.name()
        );
        Ok(())
    }
}

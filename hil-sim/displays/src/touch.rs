//! The one contact of a scene, as all displays see it.

use contact_model::material::{Material, Surface};
use thermal_client::course::{Course, CoursePoint};
use thermal_plant::PlantConfig;
use thermal_sim::scene::{Force, Scene};

/// Interval at which courses are computed, recorded and compared, s: the plant's step.
pub(crate) const STEP_S: f64 = thermal_plant::STEP_S;

/// A finger that lands on an object at once and stays under a constant force.
#[derive(Clone, Debug)]
pub struct SingleContact {
    /// Time of the landing in the scene, s.
    pub landing_s: f64,
    /// Duration of the contact, s.
    pub contact_s: f64,
    /// Force, N.
    pub force_n: f64,
    /// Skin before contact, °C.
    pub skin_c: f64,
    /// Object before contact, °C.
    pub object_c: f64,
    /// The object's material.
    pub object: Material,
    /// The display's surface.
    pub display: Surface,
    /// Effusivity of the display's plate, J/(m² s^½ K).
    pub display_effusivity: f64,
    /// The plant of the scene, which begins at the landing.
    pub(crate) plant: PlantConfig,
}

/// Why a scene has no course of an earlier display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "an earlier display is computed for one contact: one [[force]] above 0 without ramp_s on an object that is there from the \
     start, and at most one more, of 0, that ends it"
)]
pub struct NoSingleContact;

impl SingleContact {
    /// The contact of a scene.
    ///
    /// # Errors
    /// The scene has none, more than one, or one that changes.
    pub fn of(scene: &Scene) -> Result<Self, NoSingleContact> {
        let (landing, lift_s) = match scene.forces.as_slice() {
            [landing] => (landing, scene.duration_s),
            [landing, lift] if lift.force_n == 0.0 && lift.ramp_s == 0.0 => (landing, lift.t_s),
            _ => return Err(NoSingleContact),
        };
        let &Force { t_s, force_n, ramp_s } = landing;
        if force_n <= 0.0 || ramp_s != 0.0 || scene.object.appears_t_s > 0.0 {
            return Err(NoSingleContact);
        }
        let contact_s = lift_s - t_s;
        let tile = &scene.params.tile;
        Ok(Self {
            landing_s: t_s,
            contact_s,
            force_n,
            skin_c: scene.skin_c,
            object_c: scene.object_c(),
            object: scene.object.material,
            display: scene.params.display,
            display_effusivity: (tile.ceramic_w_mk * tile.ceramic_j_m3k).sqrt(),
            plant: PlantConfig {
                start_s: 0.0,
                appears_s: 0.0,
                duration_s: contact_s,
                ..scene.plant_config()
            },
        })
    }

    /// Number of steps of the contact.
    pub(crate) fn steps(&self) -> u32 {
        (self.contact_s / STEP_S).round() as u32
    }

    /// A course that has a temperature, °C, computed from the time since the landing, s, at the start and after each step.
    pub(crate) fn sampled(&self, mut celsius_at: impl FnMut(f64) -> f64) -> Course {
        let points = (0..=self.steps()).map(|step| {
            let t_s = f64::from(step) * STEP_S;
            CoursePoint { t_s, celsius: celsius_at(t_s) }
        });
        course(points.collect())
    }
}

/// The course through points whose times rise from zero.
///
/// # Panics
/// A temperature is not finite, which no model returns for the finite temperatures of a scene.
pub(crate) fn course(points: Vec<CoursePoint>) -> Course {
    Course::new(points).unwrap_or_else(|error| panic!("course of a display: {error}"))
}

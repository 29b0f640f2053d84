//! Displays side by side, on an ideal tile and on the device.

use std::path::Path;

use anyhow::Context;
use serde::Serialize;
use thermal_client::course::Course;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::{ErrorFigures, errors};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use crate::display::Display;
use crate::ideal_tile::skin_on_ideal_tile;
use crate::recording::skin_on_object;
use crate::touch::{STEP_S, SingleContact};

/// The finger of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tissue {
    /// The thesis's half-space.
    HalfSpace,
    /// Layers with blood.
    Layered,
}

impl Tissue {
    /// Both.
    pub const ALL: [Self; 2] = [Self::HalfSpace, Self::Layered];

    /// Its word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HalfSpace => "half-space",
            Self::Layered => "layered",
        }
    }

    /// The tissue of a scene.
    pub fn of(scene: &Scene) -> Self {
        if scene.params.finger.is_half_space() { Self::HalfSpace } else { Self::Layered }
    }
}

/// The scene of the comparison: a finger of 34 °C presses for 10 s with 2 N on a material of 24 °C in a room of 24 °C.
///
/// # Panics
/// There is no material of this name.
pub fn scene(material: &str, tissue: Tissue) -> Scene {
    let tissue = match tissue {
        Tissue::HalfSpace => "homogeneous",
        Tissue::Layered => "layered",
    };
    let text = format!(
        "duration_s = 11.0\nskin_c = 34.0\nroom_c = 24.0\nseed = 1\n[object]\nmaterial = {material:?}\nstart_c = 24.0\n\
         [finger]\ntissue = {tissue:?}\n[[force]]\nt_s = 1.0\nforce_n = 2.0\n"
    );
    let scene = Scene::parse(&text, Path::new("comparison"));
    scene.unwrap_or_else(|error| panic!("{error}"))
}

/// One display in one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The display.
    pub display: Display,
    /// Material of the object.
    pub material: String,
    /// The finger that touches.
    pub tissue: Tissue,
    /// Engine of the device; null if it was not run.
    pub engine: Option<&'static str>,
    /// Skin on this device minus skin on the real object; null if it was not run.
    pub skin_error_mk: Option<ErrorFigures>,
    /// The same on a tile that follows the course exactly.
    pub ideal_tile_skin_error_mk: Option<ErrorFigures>,
    /// Points of the course that the device was given; null if it showed it by a mode of its own.
    pub points: Option<usize>,
    /// Largest difference of those points to the course as computed, mK.
    pub course_error_mk: Option<f64>,
    /// Whether its largest error on this device is below that of ours in the same scene; null in ours, and alone.
    pub better_than_ours: Option<bool>,
    /// The same on the ideal tile.
    pub better_than_ours_on_ideal_tile: Option<bool>,
    /// Faults that the device reported.
    pub faults: Vec<String>,
    /// Lines that the device has refused.
    pub refused_lines: Vec<String>,
}

impl Comparison {
    /// Computes what a display would have shown in a scene, on an ideal tile alone.
    ///
    /// # Errors
    /// The scene has not one simple contact, or the plant does not accept a value.
    pub fn on_ideal_tile(scene: &Scene, display: Display) -> anyhow::Result<Self> {
        let touch = SingleContact::of(scene)?;
        let context = || format!("{} on {}", display.name(), scene.object.name);
        let course = display.ideal_course(scene, &touch).with_context(context)?;
        let ideal = ideal_errors(&touch, &course).with_context(context)?;
        Ok(Self {
            display,
            material: scene.object.name.clone(),
            tissue: Tissue::of(scene),
            engine: None,
            skin_error_mk: None,
            ideal_tile_skin_error_mk: errors(ideal.into_iter()),
            points: None,
            course_error_mk: None,
            better_than_ours: None,
            better_than_ours_on_ideal_tile: None,
            faults: Vec::new(),
            refused_lines: Vec::new(),
        })
    }

    /// Runs a scene with what a display would have shown, on an ideal tile and on the device; returns the device's run, too.
    ///
    /// # Errors
    /// As [`Self::on_ideal_tile`], or the scene cannot be run.
    pub fn run(
        runner: &dyn SceneRunner,
        scene: &Scene,
        display: Display,
    ) -> anyhow::Result<(Self, Outcome)> {
        let ideal = Self::on_ideal_tile(scene, display)?;
        let context = || format!("{} on {}", display.name(), scene.object.name);
        let (told, course_error_k) =
            (display.scene(scene, &SingleContact::of(scene)?)).with_context(context)?;
        let (outcome, figures) = runner.run(&told).with_context(context)?;
        let comparison = Self {
            engine: Some(figures.engine),
            skin_error_mk: figures.skin_error_mk,
            points: told.course.as_ref().map(|course| course.points().len()),
            course_error_mk: course_error_k.map(|error_k| error_k * 1e3),
            faults: figures.faults.into_iter().map(|trip| trip.fault).collect(),
            refused_lines: (figures.refused_lines.into_iter())
                .map(|refused| format!("{}: {}", refused.line.unwrap_or_default(), refused.answer))
                .collect(),
            ..ideal
        };
        Ok((comparison, outcome))
    }

    /// Largest skin error from 50 ms after the landing on, on this device, mK.
    pub fn max_mk(&self) -> Option<f64> {
        self.skin_error_mk?.max_after_50ms
    }

    /// The same on the ideal tile.
    pub fn ideal_max_mk(&self) -> Option<f64> {
        self.ideal_tile_skin_error_mk?.max_after_50ms
    }
}

/// Time since the landing, s, and skin error, K, of a course on an ideal tile.
fn ideal_errors(touch: &SingleContact, course: &Course) -> anyhow::Result<Vec<(f64, f64)>> {
    let shown_c = skin_on_ideal_tile(touch, course)?;
    let real_c = skin_on_object(touch)?;
    let pairs = shown_c.iter().zip(&real_c).enumerate();
    Ok(pairs.map(|(step, (shown_c, real_c))| (step as f64 * STEP_S, shown_c - real_c)).collect())
}

/// What a display is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Description {
    /// The display.
    pub display: Display,
    /// What the source says of it.
    pub source: &'static str,
    /// What had to be assumed.
    pub assumed: &'static str,
}

/// Displays side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The displays.
    pub displays: Vec<Description>,
    /// One for each display and scene.
    pub rows: Vec<Comparison>,
}

impl Report {
    /// The report of comparisons of which each scene has one of ours at most.
    pub fn new(mut rows: Vec<Comparison>) -> Self {
        let ours: Vec<_> =
            rows.iter().filter(|row| row.display == Display::Ours).cloned().collect();
        for row in &mut rows {
            let same =
                |ours: &&Comparison| (&ours.material, ours.tissue) == (&row.material, row.tissue);
            let Some(ours) = ours.iter().find(same).filter(|_| row.display != Display::Ours) else {
                continue;
            };
            let below = |own: Option<f64>, ours: Option<f64>| Some(own? < ours?);
            row.better_than_ours = below(row.max_mk(), ours.max_mk());
            row.better_than_ours_on_ideal_tile = below(row.ideal_max_mk(), ours.ideal_max_mk());
        }
        let shown = Display::ALL.into_iter();
        let shown = shown.filter(|display| rows.iter().any(|row| row.display == *display));
        Self {
            displays: shown
                .map(|display| Description {
                    display,
                    source: display.source(),
                    assumed: display.assumed(),
                })
                .collect(),
            rows,
        }
    }
}

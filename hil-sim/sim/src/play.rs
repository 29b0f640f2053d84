//! A course of temperature that is played under a finger.

use std::path::Path;

use serde::Serialize;
use thermal_client::course::Prepared;

use crate::metrics::{
    CurrentFigures, ErrorFigures, Extremes, Figures, RefusedLine, TripRecord, course_errors, errors,
};
use crate::run::Outcome;
use crate::scene::{Scene, SceneError};
use crate::speed::Speed;

/// Time of the landing in the scene, s.
const LANDING_S: f64 = 1.0;
/// Shortest contact, s.
const CONTACT_MIN_S: f64 = 0.1;

/// The scene in which the course is played: a finger lands with a force, N, and stays until the course ends. The object, which
/// is not presented, is of granite.
///
/// # Errors
/// Force, skin or the course's duration are out of range.
pub fn scene(played: &Prepared, force_n: f64, skin_c: f64) -> Result<Scene, SceneError> {
    let contact_s = played.whole.duration_s().max(CONTACT_MIN_S);
    let duration_s = LANDING_S + (contact_s * 1e3).ceil() / 1e3;
    let text = format!(
        "duration_s = {duration_s:?}\nskin_c = {skin_c:?}\nroom_c = 24.0\nseed = 1\n[object]\nmaterial = \"granite\"\n\
         [[force]]\nt_s = {LANDING_S:?}\nforce_n = {force_n:?}\n"
    );
    let scene = Scene::parse(&text, Path::new("play"))?;
    Ok(Scene { course: Some(played.points.clone()), ..scene })
}

/// The figures of a played course, as `--json` prints them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlayFigures {
    /// Name of the engine.
    pub engine: &'static str,
    /// Points that the device was given.
    pub points: usize,
    /// Largest difference of those points to the course, mK.
    pub reduction_error_mk: f64,
    /// Display minus course during contact; null without one.
    pub course_error_mk: Option<ErrorFigures>,
    /// Control ticks of the scene.
    pub ticks: usize,
    /// Display's surface under the finger, °C.
    pub display_c: Extremes,
    /// Skin on the display, °C.
    pub skin_c: Extremes,
    /// Thermal dose of that skin, equivalent minutes at 43 °C.
    pub cem43_min: f64,
    /// Current through the module.
    pub current_a: CurrentFigures,
    /// How much faster than real time the run was.
    #[serde(flatten)]
    pub speed: Speed,
    /// Faults that the device reported.
    pub faults: Vec<TripRecord>,
    /// Lines that the device has refused.
    pub refused_lines: Vec<RefusedLine>,
}

impl PlayFigures {
    /// The figures of a run of [`scene`], whose errors are against the course as it was.
    pub fn new(played: &Prepared, scene: &Scene, outcome: &Outcome, figures: Figures) -> Self {
        let whole = Scene { course: Some(played.whole.clone()), ..scene.clone() };
        Self {
            engine: figures.engine,
            points: played.points.points().len(),
            reduction_error_mk: played.error_k * 1e3,
            course_error_mk: errors(course_errors(&whole, outcome)),
            ticks: figures.ticks,
            display_c: figures.display_c,
            skin_c: figures.skin_c,
            cem43_min: figures.cem43_min,
            current_a: figures.current_a,
            speed: figures.speed,
            faults: figures.faults,
            refused_lines: figures.refused_lines,
        }
    }

    /// The figures as text.
    pub fn table(&self) -> String {
        let number = |mk: Option<f64>| mk.map_or("-".into(), |mk| format!("{mk:.1} mK"));
        let errors = self.course_error_mk;
        let mut text = format!(
            "engine              {}\n\
             points              {}, reduction error {:.2} mK\n\
             display - course    {} at most after 50 ms, {} rms\n\
             display             {:.3} to {:.3} °C\n\
             skin                {:.3} to {:.3} °C\n\
             current             {:.2} A at most\n",
            self.engine,
            self.points,
            self.reduction_error_mk,
            number(errors.and_then(|errors| errors.max_after_50ms)),
            number(errors.map(|errors| errors.rms)),
            self.display_c.min,
            self.display_c.max,
            self.skin_c.min,
            self.skin_c.max,
            self.current_a.max_abs,
        );
        for trip in &self.faults {
            text += &format!("fault               {} at {:.3} s\n", trip.fault, trip.t_s);
        }
        for refused in &self.refused_lines {
            let line = refused.line.as_deref().unwrap_or("");
            text += &format!("refused             {line}: {}\n", refused.answer);
        }
        text
    }
}

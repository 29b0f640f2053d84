//! One run, reduced to its figures.

use std::cmp::Ordering;

use serde::Serialize;
use thermal_device::control::Law;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::{Figures, skin_errors};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::{FidelityCase, JudgedFigure, RemovedLimit, Scenario};

/// A run's figures and what it was a run of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FidelityRow {
    /// Scenario.
    pub scenario: Scenario,
    /// What of it.
    pub case: String,
    /// Largest force, N.
    pub force_n: f64,
    /// Skin before contact, °C.
    pub skin_before_c: f64,
    /// Object before contact, °C.
    pub object_c: f64,
    /// Name of the law.
    pub law: &'static str,
    /// The bound that the plant does not have.
    pub without: Option<RemovedLimit>,
    /// What is held against a bound.
    pub judged: JudgedFigure,
    /// All figures.
    #[serde(flatten)]
    pub figures: Figures,
    /// Time since the first landing, s, and error of the skin, mK, at even steps of the logarithm of time.
    #[serde(skip)]
    pub error_over_time: Vec<(f64, f64)>,
}

impl FidelityRow {
    /// Runs a case.
    ///
    /// # Errors
    /// The plant cannot be so, the device stopped, or it refused the scene.
    pub fn run(
        device: &dyn SceneRunner,
        case: &FidelityCase,
        law: Law,
        without: Option<RemovedLimit>,
        seed: u64,
    ) -> anyhow::Result<Self> {
        let plant = without.map_or(Vec::new(), RemovedLimit::plant);
        let scene = case.scene(law, seed, &plant)?;
        let (outcome, figures) = device.run(&scene)?;
        Ok(Self {
            scenario: case.scenario,
            case: case.name.clone(),
            force_n: case.force_n,
            skin_before_c: case.skin_c,
            object_c: case.object_c,
            law: law.name(),
            without,
            judged: case.measure.evaluate(&scene, &outcome),
            error_over_time: error_over_time(&scene, &outcome),
            figures,
        })
    }

    /// Which of two is worse, the worse one greater: by what is judged, where no value is worst, then by the error's
    /// root mean square.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let judged = |row: &Self| match row.judged.value {
            None => f64::INFINITY,
            Some(value) if row.judged.figure == "limited" => -value,
            Some(value) => value,
        };
        let rms = |row: &Self| row.figures.skin_rms_mk().unwrap_or(0.0);
        let by = |value: fn(&Self) -> f64| value(self).total_cmp(&value(other));
        by(judged).then(by(rms))
    }
}

/// Points of an error curve for each factor of ten of time.
const POINTS: f64 = 40.0;

/// Errors of the first contact, thinned out.
fn error_over_time(scene: &Scene, outcome: &Outcome) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (since_s, error_k) in skin_errors(scene, outcome) {
        let last_s = points.last().map_or(0.0, |(last_s, _)| *last_s);
        if since_s < last_s {
            break;
        }
        if since_s > 0.0 && since_s >= last_s * 10f64.powf(1.0 / POINTS) {
            points.push((since_s, error_k * 1e3));
        }
    }
    points
}

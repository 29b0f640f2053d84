//! The figures of one run.

use std::cmp::Ordering;

use serde::Serialize;
use thermal_device::control::Law;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::{Figures, skin_errors};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::{FidelityCase, JudgedFigure, RemovedLimit, Scenario};

/// The figures of a run with its case, law and removed limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FidelityRow {
    /// Scenario.
    pub scenario: Scenario,
    /// Name of the case.
    pub case: String,
    /// Largest force, N.
    pub force_n: f64,
    /// Skin before contact, °C.
    pub skin_before_c: f64,
    /// Object before contact, °C.
    pub object_c: f64,
    /// Name of the law.
    pub law: &'static str,
    /// The limit that is removed from the plant.
    pub without: Option<RemovedLimit>,
    /// The figure that is compared with a bound.
    pub judged: JudgedFigure,
    /// All figures.
    #[serde(flatten)]
    pub figures: Figures,
    /// Time since the first landing, s, and skin error, mK, at logarithmically spaced times.
    #[serde(skip)]
    pub error_over_time: Vec<(f64, f64)>,
}

impl FidelityRow {
    /// Runs a case.
    ///
    /// # Errors
    /// The plant is not valid, the device stopped, or it refused the scene.
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

    /// Orders rows by the bounded figure, then by the RMS skin error; the worse one is greater, and no value is worst.
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

/// Points of an error curve per decade of time.
const POINTS: f64 = 40.0;

/// Errors of the first contact at logarithmically spaced times.
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

//! The fault matrix: its runs, and a summary of each fault.

use serde::Serialize;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;

use super::{DrawnDevice, FaultCase, FaultRun, FaultScene, InjectionPoint, Touch};

/// Drawn devices of a matrix; each tuned one must be commissioned.
const DEVICES: u64 = 16;

/// The part of the matrix to run.
#[derive(Clone, Debug)]
pub struct MatrixPlan {
    /// Fault cases.
    pub fault_cases: Vec<FaultCase>,
    /// Scenes.
    pub scenes: Vec<FaultScene>,
    /// Number of runs of each fault case. Every other one is on a drawn device, tuned or not, under a drawn finger.
    pub moments: usize,
    /// Seed of every draw and of the device's converter.
    pub seed: u64,
}

impl MatrixPlan {
    /// The runs. The scenes in which a fault is worst come first, the others in random order; with more runs than scenes they
    /// repeat.
    pub fn runs(&self) -> Vec<MatrixRun> {
        let mut runs = Vec::new();
        for (row, fault_case) in self.fault_cases.iter().enumerate() {
            let name = fault_case.fault.to_string();
            let mut scenes = self.scenes.clone();
            scenes.retain(|place| !fault_case.never_at.contains(place));
            scenes.sort_by_key(|place| {
                let first = fault_case.scenes.iter().position(|worst| worst == place);
                (
                    first.unwrap_or(usize::MAX),
                    stream_seed(self.seed, &format!("{name} {}", place.name())),
                )
            });
            for (k, place) in scenes.iter().cycle().take(self.moments).enumerate() {
                let seed = stream_seed(self.seed, &format!("{name} {k}"));
                let point = place.injection_point(seed, k % 2 == 0);
                runs.push(self.run_at(row, point, (k % 2 == 1).then_some(seed)));
            }
        }
        runs
    }

    /// A run on the nominal device, or on one that a seed draws. Of a learnt finger more is expected than a drawn one allows.
    fn run_at(&self, row: usize, point: InjectionPoint, drawn: Option<u64>) -> MatrixRun {
        let fault_case = self.fault_cases[row];
        let drawn = drawn.filter(|_| fault_case.learning.is_none());
        let (device, touch) = match drawn {
            None => (DrawnDevice::nominal(self.seed), fault_case.touch(self.seed)),
            Some(seed) => {
                let number = seed % DEVICES;
                let of_kind = if point.scene.needs_tuned() { number & !1 } else { number };
                let (material, _) = point.scene.object();
                (DrawnDevice::new(self.seed, of_kind), Touch::new(seed, material))
            }
        };
        MatrixRun { row, fault_case, point, device, touch }
    }
}

/// One fault at one time of one scene, on one device under one finger.
#[derive(Clone, Debug)]
pub struct MatrixRun {
    /// Index of the fault case.
    pub row: usize,
    fault_case: FaultCase,
    point: InjectionPoint,
    device: DrawnDevice,
    touch: Touch,
}

impl MatrixRun {
    /// Runs it; `None` if the fault does not apply to the engine.
    ///
    /// # Errors
    /// The scene is not valid.
    pub fn run(&self, engine: &dyn SceneRunner) -> anyhow::Result<Option<FaultRun>> {
        let drawn = (&self.device, &self.touch);
        FaultRun::run_on(engine, &self.fault_case, self.point, drawn)
    }
}

/// Result of all runs of a fault case.
#[derive(Clone, Debug, Serialize)]
pub struct FaultSummary {
    /// The fault.
    pub fault: String,
    /// Whether the fault is latent.
    pub latent: bool,
    /// All runs; empty if the fault does not apply to the engine.
    pub trials: Vec<FaultRun>,
    /// Whether no run broke a limit.
    pub holds: bool,
}

impl FaultSummary {
    /// Summarises the runs of a fault case.
    pub fn new(fault_case: &FaultCase, trials: Vec<FaultRun>) -> Self {
        Self {
            fault: fault_case.fault.to_string(),
            latent: fault_case.latent,
            holds: trials.iter().all(FaultRun::holds),
            trials,
        }
    }

    /// The runs that broke a limit.
    pub fn failing_runs(&self) -> impl Iterator<Item = &FaultRun> {
        self.trials.iter().filter(|run| !run.holds())
    }

    /// Largest value of a figure over the runs.
    pub fn most(&self, of: impl Fn(&FaultRun) -> Option<f64>) -> Option<f64> {
        self.trials.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// Reported causes with their numbers, most frequent first.
    pub fn reasons(&self) -> Vec<(&str, usize)> {
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for trial in &self.trials {
            let reason = trial.assessment.reason.as_str();
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        reasons.sort_by_key(|(reason, count)| (usize::MAX - count, *reason));
        reasons
    }
}

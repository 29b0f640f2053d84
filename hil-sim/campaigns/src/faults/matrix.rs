//! The fault matrix: its runs, and a summary of each fault.

use serde::Serialize;
use thermal_plant::parameters::stream_seed;

use super::{FaultCase, FaultRun, FaultScene, InjectionPoint};

/// The part of the matrix to run.
#[derive(Clone, Debug)]
pub struct MatrixPlan {
    /// Fault cases.
    pub fault_cases: Vec<FaultCase>,
    /// Scenes.
    pub scenes: Vec<FaultScene>,
    /// Number of runs of each fault case.
    pub moments: usize,
    /// Seed of every draw and of the device's converter.
    pub seed: u64,
}

impl MatrixPlan {
    /// The runs: index of the fault case, and scene and time. The scenes in which a fault is worst come first, the others in
    /// random order; with more runs than scenes they repeat.
    pub fn runs(&self) -> Vec<(usize, InjectionPoint)> {
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
                runs.push((row, place.injection_point(seed, k % 2 == 0)));
            }
        }
        runs
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

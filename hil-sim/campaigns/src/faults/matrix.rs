//! What of the matrix is run, and what came of each row.

use serde::Serialize;
use thermal_plant::parameters::stream;

use super::{FaultCase, FaultRun, FaultScene, InjectionPoint};

/// A part of the matrix.
#[derive(Clone, Debug)]
pub struct MatrixPlan {
    /// Rows.
    pub fault_cases: Vec<FaultCase>,
    /// Places.
    pub scenes: Vec<FaultScene>,
    /// Moments of each row.
    pub moments: usize,
    /// Of every draw, and of the device's converter.
    pub seed: u64,
}

impl MatrixPlan {
    /// The runs: the row's number, and the moment. The scenes where a fault case is worst come first, the others in an order
    /// that is drawn for it; if there are more moments than scenes they come again.
    #[must_use]
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
                    stream(self.seed, &format!("{name} {}", place.name())),
                )
            });
            for (k, place) in scenes.iter().cycle().take(self.moments).enumerate() {
                let seed = stream(self.seed, &format!("{name} {k}"));
                runs.push((row, place.moment(seed, k % 2 == 0)));
            }
        }
        runs
    }
}

/// What came of a row.
#[derive(Clone, Debug, Serialize)]
pub struct FaultSummary {
    /// The fault.
    pub fault: String,
    /// It shows at the next self-test only, or not at all.
    pub latent: bool,
    /// All runs; none if the engine has no part that could fail so.
    pub trials: Vec<FaultRun>,
    /// No run has a breach.
    pub holds: bool,
}

impl FaultSummary {
    /// Sums up the runs of a fault case.
    #[must_use]
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

    /// Largest of a figure over the runs.
    #[must_use]
    pub fn most(&self, of: impl Fn(&FaultRun) -> Option<f64>) -> Option<f64> {
        self.trials.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// Reasons that were given, the most frequent first, and how often.
    #[must_use]
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

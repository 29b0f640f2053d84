//! Pairs of faults: a latent fault, followed by another one.

use std::fmt::Write;

use serde::Serialize;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;
use thermal_sim::scene::FaultKind;

use super::table::failing_run_text;
use super::{
    Breach, DrawnDevice, ExpectedReaction, FaultCase, FaultRun, FaultScene, InjectedFault,
    InjectionPoint, Touch, fault_cases, fault_run,
};

/// Time of the latent fault, s: after the first self-test and before every injection time.
const LATENT_S: f64 = 0.05;

/// A latent fault and a second fault that follows it.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultPair {
    /// The latent fault.
    pub latent: FaultCase,
    /// The second fault.
    pub active: FaultCase,
    /// Scene and time of the second fault.
    pub point: InjectionPoint,
}

/// Whether a fault can stay unnoticed: it lasts and is harmless alone, or is detectable only at the next self-test or drive.
fn is_latent(fault_case: &FaultCase) -> bool {
    let InjectedFault::Hardware(broken) = fault_case.fault else {
        return false;
    };
    match broken.kind {
        FaultKind::HostFlood => false,
        FaultKind::MirrorStuck => broken.value == 0.0,
        kind => fault_case.latent || fault_case.symptoms.is_empty() && kind.has_duration(),
    }
}

/// Every latent fault before every other fault of the list, each at one random time, in the first scene without a later
/// self-test in which the second fault is worst. Those of the heat-flux sensor are left out: they change set-points only, within
/// what fingers do.
pub fn pairs(seed: u64) -> Vec<FaultPair> {
    let all = fault_cases().into_iter();
    let (latent, active): (Vec<_>, Vec<_>) =
        all.filter(|fault_case| fault_case.learning.is_none()).partition(is_latent);
    let mut pairs = Vec::with_capacity(latent.len() * active.len());
    for latent in &latent {
        for active in &active {
            let name = format!("{} {}", latent.fault, active.fault);
            let means = |place: &&FaultScene| {
                let never = [latent.never_at, active.never_at];
                place.has_tripped_before().is_none() && !never.concat().contains(place)
            };
            let mut rest: Vec<_> = FaultScene::ALL.iter().collect();
            rest.sort_by_key(|place| stream_seed(seed, &format!("{name} {}", place.name())));
            let place = active.scenes.iter().chain(rest).find(means);
            pairs.extend(place.map(|place| FaultPair {
                latent: *latent,
                active: *active,
                point: place.injection_point(stream_seed(seed, &name), false),
            }));
        }
    }
    pairs
}

impl FaultPair {
    /// Text of the scene.
    pub fn text(&self, seed: u64) -> String {
        let Self { latent, active, point } = self;
        let faults = [(latent.fault, LATENT_S), (active.fault, point.t_s)];
        let nominal = (&DrawnDevice::nominal(seed), &Touch::default());
        fault_run::scene_text(&faults, *point, latent.after_s.max(active.after_s), nominal)
    }

    /// Runs the pair; `None` if a fault does not apply to the engine. A trip caused by the latent fault is correct.
    ///
    /// # Errors
    /// The scene is not valid.
    pub fn run(&self, device: &dyn SceneRunner, seed: u64) -> anyhow::Result<Option<PairResult>> {
        let trial = FaultRun::run_text(device, &self.active, self.point, &self.text(seed))?;
        Ok(trial.map(|mut trial| {
            let assessment = &mut trial.assessment;
            let named = match self.latent.expected {
                ExpectedReaction::Trip(faults) => {
                    faults.iter().any(|fault| fault.name() == assessment.reason)
                }
                ExpectedReaction::Restart => false,
            };
            // A latent fault without a symptom explains the trip cause only if it was reported before the second fault.
            let first =
                !self.latent.symptoms.is_empty() || assessment.breaches.contains(&Breach::Early);
            (assessment.breaches).retain(|breach| {
                !(named && first && matches!(breach, Breach::Reason | Breach::Early))
            });
            PairResult {
                latent: self.latent.fault.to_string(),
                active: self.active.fault.to_string(),
                trial,
            }
        }))
    }
}

/// Result of a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairResult {
    /// The first fault.
    pub latent: String,
    /// The second.
    pub active: String,
    /// Scene, moment of the second, and assessment.
    #[serde(flatten)]
    pub trial: FaultRun,
}

/// A line for every latent fault; then every pair that breaks the claim.
pub fn pair_table(runs: &[PairResult]) -> String {
    let width = runs.iter().map(|run| run.latent.len()).max().unwrap_or(0).max(6);
    let mut text = format!("{:width$}  pairs  break  coldest C  warmest C  to safe ms\n", "latent");
    // The runs stand in the order of their latent faults.
    for of_one in runs.chunk_by(|a, b| a.latent == b.latent) {
        let verdicts = || of_one.iter().map(|run| &run.trial.assessment);
        let broken = of_one.iter().filter(|run| !run.trial.holds()).count();
        let coldest =
            verdicts().map(|assessment| assessment.skin_c.min).fold(f64::INFINITY, f64::min);
        let warmest =
            (verdicts().map(|assessment| assessment.skin_c.max)).fold(f64::NEG_INFINITY, f64::max);
        let slowest = verdicts().filter_map(|assessment| assessment.took_ms).fold(0.0, f64::max);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:width$}  {:>5}  {broken:>5}  {coldest:>9.2}  {warmest:>9.2}  {slowest:>10.0}",
            of_one[0].latent,
            of_one.len(),
        );
    }
    for run in runs.iter().filter(|run| !run.trial.holds()) {
        let _ =
            writeln!(text, "{}, then {}: {}", run.latent, run.active, failing_run_text(&run.trial));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Those that the claim about pairs names.
    #[test]
    fn every_latent_fault_comes_before_every_active_one() {
        let pairs = pairs(1);
        for name in ["comparator-dead", "fault-pin-dead", "bridge-enable-stuck", "mirror-stuck 0 A"]
        {
            let of_one = pairs.iter().filter(|pair| pair.latent.fault.to_string() == name);
            let active: Vec<_> = of_one.map(|pair| pair.active.fault.to_string()).collect();
            for other in
                ["sensors-swapped display check", "bridge-stuck-high", "hung-core", "host-silent"]
            {
                let is_latent = pairs.iter().any(|pair| pair.latent.fault.to_string() == other);
                assert!(is_latent || active.iter().any(|known| known == other), "{name}, {other}");
            }
        }
        assert!(pairs.iter().all(|pair| pair.point.t_s > LATENT_S));
    }
}

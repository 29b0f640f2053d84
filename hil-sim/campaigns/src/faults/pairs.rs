//! Pairs of faults: one that nobody has noticed, then one that acts.

use std::fmt::Write;

use serde::Serialize;
use thermal_plant::parameters::stream;
use thermal_sim::SceneRunner;
use thermal_sim::scene::FaultKind;

use super::table::broken;
use super::{
    Breach, ExpectedReaction, FaultCase, FaultRun, FaultScene, InjectedFault, InjectionPoint,
    fault_cases, fault_run,
};

/// When the first fault comes, s: after the self-test that settling begins with, before every moment of a place.
const LATENT_S: f64 = 0.05;

/// A fault that may have been there for long before another one comes.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultPair {
    /// Comes first.
    pub latent: FaultCase,
    /// Comes at the moment.
    pub active: FaultCase,
    /// Where and when.
    pub moment: InjectionPoint,
}

/// Whether a fault may go unnoticed: it is harmless alone and lasts, or shows at the next self-test or drive only.
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

/// Every latent fault before every other one of the list, each at one moment of the seed: in the first place where the
/// second is worst, of those in which no self-test follows.
#[must_use]
pub fn pairs(seed: u64) -> Vec<FaultPair> {
    let (latent, active): (Vec<_>, Vec<_>) = fault_cases().into_iter().partition(is_latent);
    let mut pairs = Vec::with_capacity(latent.len() * active.len());
    for latent in &latent {
        for active in &active {
            let name = format!("{} {}", latent.fault, active.fault);
            let means = |place: &&FaultScene| {
                let never = [latent.never_at, active.never_at];
                place.has_tripped_before().is_none() && !never.concat().contains(place)
            };
            let mut rest: Vec<_> = FaultScene::ALL.iter().collect();
            rest.sort_by_key(|place| stream(seed, &format!("{name} {}", place.name())));
            let place = active.scenes.iter().chain(rest).find(means);
            pairs.extend(place.map(|place| FaultPair {
                latent: *latent,
                active: *active,
                moment: place.moment(stream(seed, &name), false),
            }));
        }
    }
    pairs
}

impl FaultPair {
    /// Its scene as a file has it.
    #[must_use]
    pub fn text(&self, seed: u64) -> String {
        let Self {
            latent,
            active,
            moment,
        } = self;
        let faults = [(latent.fault, LATENT_S), (active.fault, moment.t_s)];
        fault_run::scene_text(
            &faults,
            *moment,
            latent.after_s.max(active.after_s),
            seed,
            &[],
        )
    }

    /// Runs it; none if the engine has no part that could fail so. That the first fault is noticed, and named, is right.
    ///
    /// # Errors
    /// The scene cannot be.
    pub fn run(&self, device: &dyn SceneRunner, seed: u64) -> anyhow::Result<Option<PairResult>> {
        let trial = FaultRun::of_text(device, &self.active, self.moment, &self.text(seed))?;
        Ok(trial.map(|mut trial| {
            let assessment = &mut trial.assessment;
            let named = match self.latent.expected {
                ExpectedReaction::Trip(faults) => {
                    faults.iter().any(|fault| fault.name() == assessment.reason)
                }
                ExpectedReaction::Restart => false,
            };
            // What has no sign, and has not been named before the second fault, is no excuse for its reason.
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

/// What came of a pair.
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
#[must_use]
pub fn pair_table(runs: &[PairResult]) -> String {
    let width = runs
        .iter()
        .map(|run| run.latent.len())
        .max()
        .unwrap_or(0)
        .max(6);
    let mut text = format!(
        "{:width$}  pairs  break  coldest C  warmest C  to safe ms\n",
        "latent"
    );
    // The runs stand in the order of their latent faults.
    for of_one in runs.chunk_by(|a, b| a.latent == b.latent) {
        let verdicts = || of_one.iter().map(|run| &run.trial.assessment);
        let broken = of_one.iter().filter(|run| !run.trial.holds()).count();
        let coldest = verdicts()
            .map(|assessment| assessment.skin_c.min)
            .fold(f64::INFINITY, f64::min);
        let warmest =
            (verdicts().map(|assessment| assessment.skin_c.max)).fold(f64::NEG_INFINITY, f64::max);
        let slowest = verdicts()
            .filter_map(|assessment| assessment.took_ms)
            .fold(0.0, f64::max);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:width$}  {:>5}  {broken:>5}  {coldest:>9.2}  {warmest:>9.2}  {slowest:>10.0}",
            of_one[0].latent,
            of_one.len(),
        );
    }
    for run in runs.iter().filter(|run| !run.trial.holds()) {
        let _ = writeln!(
            text,
            "{}, then {}: {}",
            run.latent,
            run.active,
            broken(&run.trial)
        );
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
        for name in [
            "comparator-dead",
            "fault-pin-dead",
            "bridge-enable-stuck",
            "mirror-stuck 0 A",
        ] {
            let of_one = pairs
                .iter()
                .filter(|pair| pair.latent.fault.to_string() == name);
            let active: Vec<_> = of_one.map(|pair| pair.active.fault.to_string()).collect();
            for other in [
                "sensors-swapped display check",
                "bridge-stuck-high",
                "hung-core",
                "host-silent",
            ] {
                let is_latent = pairs
                    .iter()
                    .any(|pair| pair.latent.fault.to_string() == other);
                assert!(
                    is_latent || active.iter().any(|known| known == other),
                    "{name}, {other}"
                );
            }
        }
        assert!(pairs.iter().all(|pair| pair.moment.t_s > LATENT_S));
    }
}

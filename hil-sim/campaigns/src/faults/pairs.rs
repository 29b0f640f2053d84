//! Pairs of faults: one that nobody has noticed, then one that acts.

use std::fmt::Write;

use serde::Serialize;
use thermal_plant::parameters::stream_seed;
use thermal_sim::Device;
use thermal_sim::scene::FaultKind;

use super::table::broken;
use super::{Breach, Entry, Injected, Moment, Place, Right, Trial, entries, trial};

/// When the first fault comes, s: after the self-test that settling begins with, before every moment of a place.
const LATENT_S: f64 = 0.05;

/// A fault that may have been there for long before another one comes.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Comes first.
    pub latent: Entry,
    /// Comes at the moment.
    pub active: Entry,
    /// Where and when.
    pub moment: Moment,
}

/// Whether a fault may go unnoticed: it is harmless alone and lasts, or shows at the next self-test or drive only.
fn is_latent(entry: &Entry) -> bool {
    let Injected::Broken(broken) = entry.fault else {
        return false;
    };
    match broken.kind {
        FaultKind::HostFlood => false,
        FaultKind::MirrorStuck => broken.value == 0.0,
        kind => entry.latent || entry.signs.is_empty() && kind.lasts(),
    }
}

/// Every latent fault before every other one of the list, each at one moment of the seed: in the first place where the
/// second is worst, of those in which no self-test follows.
#[must_use]
pub fn pairs(seed: u64) -> Vec<Pair> {
    let (latent, active): (Vec<_>, Vec<_>) = entries().into_iter().partition(is_latent);
    let mut pairs = Vec::with_capacity(latent.len() * active.len());
    for latent in &latent {
        for active in &active {
            let name = format!("{} {}", latent.fault, active.fault);
            let means = |place: &&Place| {
                let never = [latent.never_at, active.never_at];
                place.has_tripped_before().is_none() && !never.concat().contains(place)
            };
            let mut rest: Vec<_> = Place::ALL.iter().collect();
            rest.sort_by_key(|place| stream_seed(seed, &format!("{name} {}", place.name())));
            let place = active.places.iter().chain(rest).find(means);
            pairs.extend(place.map(|place| Pair {
                latent: *latent,
                active: *active,
                moment: place.moment(stream_seed(seed, &name), false),
            }));
        }
    }
    pairs
}

impl Pair {
    /// Its scene as a file has it.
    #[must_use]
    pub fn text(&self, seed: u64) -> String {
        let Self {
            latent,
            active,
            moment,
        } = self;
        let faults = [(latent.fault, LATENT_S), (active.fault, moment.t_s)];
        trial::text(
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
    pub fn run(&self, device: &dyn Device, seed: u64) -> anyhow::Result<Option<RanPair>> {
        let trial = Trial::of_text(device, &self.active, self.moment, &self.text(seed))?;
        Ok(trial.map(|mut trial| {
            let verdict = &mut trial.verdict;
            let named = match self.latent.right {
                Right::Trip(faults) => faults.iter().any(|fault| fault.name() == verdict.reason),
                Right::Restart => false,
            };
            // What has no sign, and has not been named before the second fault, is no excuse for its reason.
            let first = !self.latent.signs.is_empty() || verdict.breaches.contains(&Breach::Early);
            (verdict.breaches).retain(|breach| {
                !(named && first && matches!(breach, Breach::Reason | Breach::Early))
            });
            RanPair {
                latent: self.latent.fault.to_string(),
                active: self.active.fault.to_string(),
                trial,
            }
        }))
    }
}

/// What came of a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RanPair {
    /// The first fault.
    pub latent: String,
    /// The second.
    pub active: String,
    /// Scene, moment of the second, and verdict.
    #[serde(flatten)]
    pub trial: Trial,
}

impl RanPair {
    /// Nothing was broken that is claimed.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.trial.verdict.breaches.is_empty()
    }
}

/// A line for every latent fault; then every pair that breaks the claim.
#[must_use]
pub fn pair_table(runs: &[RanPair]) -> String {
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
        let verdicts = || of_one.iter().map(|run| &run.trial.verdict);
        let broken = of_one.iter().filter(|run| !run.holds()).count();
        let coldest = verdicts()
            .map(|verdict| verdict.skin_c.min)
            .fold(f64::INFINITY, f64::min);
        let warmest =
            (verdicts().map(|verdict| verdict.skin_c.max)).fold(f64::NEG_INFINITY, f64::max);
        let slowest = verdicts()
            .filter_map(|verdict| verdict.took_ms)
            .fold(0.0, f64::max);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:width$}  {:>5}  {broken:>5}  {coldest:>9.2}  {warmest:>9.2}  {slowest:>10.0}",
            of_one[0].latent,
            of_one.len(),
        );
    }
    for run in runs.iter().filter(|run| !run.holds()) {
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

//! Random campaigns: fault, moment, scene and plant by seed and number.

use std::fmt::Write;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_plant::parameters::stream_seed;
use thermal_sim::Device;

use super::table::broken;
use super::{Breach, Entry, Injected, Moment, Place, Trial, entries, trial};
use crate::fidelity::Draw;

/// Campaigns in a row on the same device of the box: commissioning one takes longer than a campaign.
const ON_ONE_DEVICE: u64 = 8;

/// One fault at one moment of one scene on one device of the box.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// Its number, from 0.
    pub number: u64,
    /// What happens.
    pub entry: Entry,
    /// Where and when.
    pub moment: Moment,
    /// The device, and its plant.
    pub device: Draw,
}

impl Campaign {
    /// The campaign of a number and a seed; no other one is needed for it. Without a processor, its faults are not
    /// drawn, so the two engines' campaigns of a number differ.
    #[must_use]
    pub fn new(seed: u64, number: u64, has_processor: bool) -> Self {
        let own = stream_seed(seed, &format!("campaign {number}"));
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(own);
        let mut all = entries();
        all.retain(|entry| has_processor || !matches!(entry.fault, Injected::Processor(_)));
        let entry = all[draw.random_range(0..all.len())];
        let mut places = Place::ALL.to_vec();
        places.retain(|place| !entry.never_at.contains(place));
        let place = places[draw.random_range(0..places.len())];
        Self {
            number,
            entry,
            moment: place.moment(draw.random(), draw.random()),
            device: Draw::in_use(seed, number / ON_ONE_DEVICE),
        }
    }

    /// Its scene as a file has it.
    #[must_use]
    pub fn text(&self) -> String {
        let faults = [(self.entry.fault, self.moment.t_s)];
        let Draw { seed, plant, .. } = &self.device;
        trial::text(&faults, self.moment, self.entry.after_s, *seed, plant)
    }

    /// Runs it; none if the engine has no part that could fail so.
    ///
    /// # Errors
    /// The scene cannot be.
    pub fn run(&self, device: &dyn Device) -> anyhow::Result<Option<Ran>> {
        let trial = Trial::of_text(device, &self.entry, self.moment, &self.text())?;
        Ok(trial.map(|trial| Ran {
            number: self.number,
            fault: self.entry.fault.to_string(),
            trial,
        }))
    }
}

/// What came of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ran {
    /// Its number.
    pub number: u64,
    /// Its fault.
    pub fault: String,
    /// Scene, moment and verdict.
    #[serde(flatten)]
    pub trial: Trial,
}

impl Ran {
    /// Nothing was broken that is claimed.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.trial.verdict.breaches.is_empty()
    }
}

/// Runs, violations of each kind, the worst figures with the numbers of their campaigns; then every violation.
#[must_use]
pub fn summary(runs: &[Ran]) -> String {
    let worst = |name: &str, unit: &str, of: fn(&Trial) -> Option<f64>, sign: f64| {
        let values = runs.iter().filter_map(|run| Some((of(&run.trial)?, run)));
        let most = values
            .filter(|(value, _)| value.is_finite())
            .max_by(|(a, _), (b, _)| (sign * a).total_cmp(&(sign * b)));
        most.map_or(String::new(), |(value, run)| {
            format!(
                "{name:<16}{value:>9.3} {unit:<4} number {}, {} in {}\n",
                run.number, run.fault, run.trial.place
            )
        })
    };
    let failing = runs.iter().filter(|run| !run.holds());
    let mut text = format!(
        "{:<16}{:>9}\n{:<16}{:>9}\n",
        "runs",
        runs.len(),
        "violations",
        failing.clone().count()
    );
    for breach in Breach::ALL {
        let count = (runs.iter())
            .filter(|run| run.trial.verdict.breaches.contains(&breach))
            .count();
        if count > 0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {:<14}{count:>9}", breach.name());
        }
    }
    text += &worst(
        "coldest skin",
        "C",
        |trial| Some(trial.verdict.skin_c.min),
        -1.0,
    );
    text += &worst(
        "warmest skin",
        "C",
        |trial| Some(trial.verdict.skin_c.max),
        1.0,
    );
    text += &worst(
        "largest CEM43",
        "min",
        |trial| Some(trial.verdict.cem43_min),
        1.0,
    );
    text += &worst("slowest to safe", "ms", |trial| trial.verdict.took_ms, 1.0);
    for run in failing {
        let _ = writeln!(
            text,
            "number {}: {}: {}",
            run.number,
            run.fault,
            broken(&run.trial)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use thermal_sim::scene::Scene;

    #[test]
    fn campaigns_repeat_by_seed_and_number_and_differ_between_them() {
        assert_eq!(Campaign::new(3, 17, true), Campaign::new(3, 17, true));
        assert_ne!(
            Campaign::new(3, 17, true).text(),
            Campaign::new(3, 18, true).text()
        );
        assert_ne!(
            Campaign::new(3, 17, true).text(),
            Campaign::new(4, 17, true).text()
        );
    }

    /// 2000 draws from some 140 faults and 19 places miss one with a probability below 1e-4.
    #[test]
    fn every_fault_and_every_place_is_drawn_and_each_is_a_scene() {
        let (mut faults, mut places) = (HashSet::new(), HashSet::new());
        for number in 0..2000 {
            let campaign = Campaign::new(1, number, true);
            assert!(!campaign.entry.never_at.contains(&campaign.moment.place));
            faults.insert(campaign.entry.fault.to_string());
            places.insert(campaign.moment.place.name());
            if number % 50 == 0 {
                let scene = Scene::parse(&campaign.text(), "campaign".as_ref()).expect("a scene");
                assert_eq!(scene.seed, campaign.device.seed);
                assert_ne!(scene.params, thermal_plant::Params::nominal());
            }
        }
        assert_eq!(places.len(), Place::ALL.len());
        assert_eq!(faults.len(), entries().len());
    }

    #[test]
    fn no_processor_no_processor_faults() {
        for number in 0..500 {
            let campaign = Campaign::new(1, number, false);
            assert!(!matches!(campaign.entry.fault, Injected::Processor(_)));
        }
    }
}

//! Random campaigns: fault, time, scene and plant drawn by seed and number.

use std::fmt::Write;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;

use super::drawn_course::course_tables;
use super::table::failing_run_text;
use super::{
    Breach, DrawnDevice, FaultCase, FaultRun, FaultScene, InjectedFault, InjectionPoint, Touch,
    fault_cases, fault_run,
};

/// Share of the campaigns in whose scene the host would present an object in which it plays a course.
const WITH_COURSE: f64 = 0.3;
/// Share of the campaigns without a fault of the heat-flux sensor in which the display has one.
const WITH_FLUX_SENSOR: f64 = 0.25;
/// Time at which the course is uploaded, s: before any fault.
const COURSE_S: f64 = 0.012;
/// End of the shortest scene, s.
const COURSE_UNTIL_S: f64 = 7.0;

/// One fault at one time of one scene, on one drawn device under one drawn finger.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomCampaign {
    /// Number of the campaign, from 0.
    pub number: u64,
    /// The fault case.
    pub fault_case: FaultCase,
    /// Scene and time of the fault.
    pub point: InjectionPoint,
    /// The device and its plant.
    pub device: DrawnDevice,
    /// The finger and the object.
    pub touch: Touch,
}

impl RandomCampaign {
    /// Draws a campaign; it depends only on seed and number. Without a processor, its faults are not
    /// drawn, so the two engines' campaigns of a number differ.
    pub fn new(seed: u64, number: u64, has_processor: bool) -> Self {
        let own = stream_seed(seed, &format!("campaign {number}"));
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(own);
        let mut all = fault_cases();
        all.retain(|fault_case| {
            has_processor || !matches!(fault_case.fault, InjectedFault::Processor(_))
        });
        let mut fault_case = all[draw.random_range(0..all.len())];
        let device = DrawnDevice::new(seed, number / DrawnDevice::CAMPAIGNS);
        let mut scenes = FaultScene::ALL.to_vec();
        scenes.retain(|place| {
            !fault_case.never_at.contains(place) && (device.tuned || !place.needs_tuned())
        });
        let place = scenes[draw.random_range(0..scenes.len())];
        let point = place.injection_point(draw.random(), draw.random());
        let mut touch = Touch::new(stream_seed(own, "touch"), place.object().0);
        // A faulty trigger input starts a course that waits for an edge, as it must.
        let takes_course = device.tuned
            && !place.is_commanded()
            && place.has_tripped_before().is_none()
            && !fault_case.fault.kind().starts_with("trigger-");
        if takes_course && draw.random_bool(WITH_COURSE) {
            touch.tables += &course_tables(stream_seed(own, "course"), COURSE_S, COURSE_UNTIL_S);
        }
        let flux_seed = stream_seed(own, "flux sensor");
        let has_sensor = Xoshiro256PlusPlus::seed_from_u64(flux_seed).random_bool(WITH_FLUX_SENSOR);
        // What the device must say of the finger depends on the drawn finger.
        if fault_case.learning.take().is_some() || has_sensor {
            touch.fit_flux_sensor(flux_seed);
        }
        Self { number, fault_case, point, device, touch }
    }

    /// Text of the scene.
    pub fn text(&self) -> String {
        let faults = [(self.fault_case.fault, self.point.t_s)];
        let drawn = (&self.device, &self.touch);
        fault_run::scene_text(&faults, self.point, self.fault_case.after_s, drawn)
    }

    /// Runs the campaign; `None` if the fault does not apply to the engine.
    ///
    /// # Errors
    /// The scene is not valid.
    pub fn run(&self, device: &dyn SceneRunner) -> anyhow::Result<Option<CampaignResult>> {
        let trial = FaultRun::run_text(device, &self.fault_case, self.point, &self.text())?;
        Ok(trial.map(|trial| CampaignResult {
            number: self.number,
            fault: self.fault_case.fault.to_string(),
            trial,
        }))
    }
}

/// Result of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignResult {
    /// Number of the campaign.
    pub number: u64,
    /// The fault.
    pub fault: String,
    /// Scene, time and assessment.
    #[serde(flatten)]
    pub trial: FaultRun,
}

/// A figure whose worst value is printed: name, unit, 1 if the largest is the worst and -1 if the smallest is, and value.
type WorstFigure = (&'static str, &'static str, f64, fn(&FaultRun) -> Option<f64>);

const WORST_FIGURES: [WorstFigure; 4] = [
    ("coldest skin", "C", -1.0, |run| Some(run.assessment.skin_c.min)),
    ("warmest skin", "C", 1.0, |run| Some(run.assessment.skin_c.max)),
    ("largest CEM43", "min", 1.0, |run| Some(run.assessment.cem43_min)),
    ("slowest to safe", "ms", 1.0, |run| run.assessment.took_ms),
];

/// Table of runs, violations of each kind and worst figures with their campaigns, followed by every violation.
pub fn campaign_summary(runs: &[CampaignResult]) -> String {
    let worst = |(name, unit, sign, figure): WorstFigure| {
        let values = runs.iter().filter_map(|run| Some((figure(&run.trial)?, run)));
        let most = values
            .filter(|(value, _)| value.is_finite())
            .max_by(|(a, _), (b, _)| (sign * a).total_cmp(&(sign * b)));
        most.map_or(String::new(), |(value, run)| {
            format!(
                "{name:<16}{value:>9.3} {unit:<4} number {}, {} in {}
",
                run.number, run.fault, run.trial.place
            )
        })
    };
    let failing = runs.iter().filter(|run| !run.trial.holds());
    let mut text = format!(
        "{:<16}{:>9}\n{:<16}{:>9}\n",
        "runs",
        runs.len(),
        "violations",
        failing.clone().count()
    );
    for breach in Breach::ALL {
        let count =
            (runs.iter()).filter(|run| run.trial.assessment.breaches.contains(&breach)).count();
        if count > 0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {:<14}{count:>9}", breach.name());
        }
    }
    text.extend(WORST_FIGURES.map(worst));
    for run in failing {
        let _ = writeln!(
            text,
            "number {}: {}: {}",
            run.number,
            run.fault,
            failing_run_text(&run.trial)
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
        assert_eq!(RandomCampaign::new(3, 17, true), RandomCampaign::new(3, 17, true));
        assert_ne!(
            RandomCampaign::new(3, 17, true).text(),
            RandomCampaign::new(3, 18, true).text()
        );
        assert_ne!(
            RandomCampaign::new(3, 17, true).text(),
            RandomCampaign::new(4, 17, true).text()
        );
    }

    /// 2000 draws from some 140 faults and 19 scenes miss one with a probability below 1e-4.
    #[test]
    fn every_fault_and_every_place_is_drawn_and_each_is_a_scene() {
        let (mut faults, mut scenes) = (HashSet::new(), HashSet::new());
        for number in 0..2000 {
            let campaign = RandomCampaign::new(1, number, true);
            assert!(!campaign.fault_case.never_at.contains(&campaign.point.scene));
            faults.insert(campaign.fault_case.fault.to_string());
            scenes.insert(campaign.point.scene.name());
            if number % 50 == 0 {
                let scene = Scene::parse(&campaign.text(), "campaign".as_ref()).expect("a scene");
                assert_eq!(scene.seed, campaign.device.seed);
                assert_ne!(scene.params, thermal_plant::Params::nominal());
            }
        }
        assert!((0..200).any(|number| {
            let text = RandomCampaign::new(1, number, true).text();
            text.contains("upload begin course") && text.contains("appears_t_s = 0.0")
        }));
        assert_eq!(scenes.len(), FaultScene::ALL.len());
        assert_eq!(faults.len(), fault_cases().len());
    }

    #[test]
    fn an_engine_without_a_processor_gets_no_processor_faults() {
        for number in 0..500 {
            let campaign = RandomCampaign::new(1, number, false);
            assert!(!matches!(campaign.fault_case.fault, InjectedFault::Processor(_)));
        }
    }
}

//! Faults on the device for five fingers: of one finger's plant, and of what the fingers share.
//!
//! The finger with the fault is assessed like a finger alone; a fault of what is shared is assessed on every finger. The
//! other fingers must render as in the same scenes without the fault.

use std::path::Path;

use anyhow::Context;
use thermal_plant::parameters::stream_seed;
use thermal_sim::five_fingers::{FINGERS, FiveFingerRunner, STREAM_MS};
use thermal_sim::metrics::Figures;
use thermal_sim::processor::NotInjected;
use thermal_sim::run::Outcome;
use thermal_sim::scene::{FaultKind, Scene, ScheduledFault};
use thermal_sim::trace::TraceRow;

use super::assessment::{RunAssessment, works_at_end};
use super::fault_run::scene_text;
use super::{
    Breach, DrawnDevice, FaultCase, FaultRun, FaultScene, FaultSummary, InjectedFault,
    InjectionPoint, Touch, fault_cases, list,
};

/// Scenes of the fingers, in which they are in contact when a fault comes.
const CONTACT: [FaultScene; FINGERS] =
    [FaultScene::Granite, FaultScene::Copper, FaultScene::Slew, FaultScene::Warm, FaultScene::Cold];
/// Scenes in which all fingers run their self-test after the fault.
const SELF_TEST: [FaultScene; FINGERS] = [FaultScene::Off; FINGERS];
/// Duration of the scenes after a fault, s: longer than a host is silent, shorter than a sink takes to warm without a fan.
const AFTER_S: f64 = 7.0;
/// Duration of a flood of lines, s. Each of them is answered, which takes the line four times as long, and the fingers'
/// answers at the end must not wait behind that.
const FLOOD_S: f64 = 1.0;
/// Largest difference of another finger's skin from the run without the fault, K; a person notices some 20 mK.
const OTHERS_K: f64 = 1e-3;

/// The fault cases for five fingers: the first of each kind in the list, but for those of the heat-flux sensor, which this device
/// has not, and those of the select lines.
pub fn five_finger_cases() -> Vec<FaultCase> {
    let mut cases: Vec<FaultCase> = Vec::new();
    for case in fault_cases().into_iter().chain(list::select_line_cases()) {
        let of_select_line = |case: &FaultCase| case.fault.kind().starts_with("select-line");
        let is_known = cases.iter().any(|known| known.fault.kind() == case.fault.kind());
        if case.learning.is_none() && (!is_known || of_select_line(&case)) {
            cases.push(case);
        }
    }
    cases
}

/// Whether the fault is one of what the fingers share.
fn is_shared(fault: &InjectedFault) -> bool {
    match fault {
        InjectedFault::Processor(_) => true,
        InjectedFault::HostLine(_) => false,
        InjectedFault::Hardware(fault) => fault.kind.is_shared(),
    }
}

/// Whether only the first finger's host sends too much; all simulated hosts share the line.
const fn is_of_one_host(kind: FaultKind) -> bool {
    matches!(kind, FaultKind::HostFlood | FaultKind::HostPlays)
}

/// A fault case with the scenes of all fingers, and the time of the fault.
#[derive(Clone, Debug)]
pub struct FiveFingerRun {
    /// The fault case.
    pub fault_case: FaultCase,
    /// The finger with the fault; `None` if all share it.
    finger: Option<usize>,
    /// Scenes of the fingers.
    places: [FaultScene; FINGERS],
    /// Time of the fault, s.
    t_s: f64,
    seed: u64,
}

impl FiveFingerRun {
    /// The runs of fault cases: each on one of the fingers 1 to 4, in the scene in which it is worst.
    pub fn all(cases: Vec<FaultCase>, seed: u64) -> Vec<Self> {
        (cases.into_iter().enumerate()).map(|(i, case)| Self::new(case, i, seed)).collect()
    }

    fn new(fault_case: FaultCase, index: usize, seed: u64) -> Self {
        let others = 1..FINGERS;
        let any = 1 + index % others.len();
        let allowed = |place: &FaultScene| !fault_case.never_at.contains(place);
        let at = |place: &FaultScene| match CONTACT.iter().skip(1).position(|known| known == place)
        {
            Some(finger) => Some((CONTACT, 1 + finger)),
            None => (SELF_TEST.contains(place)).then_some((SELF_TEST, any)),
        };
        let mut worst = fault_case.scenes.iter().filter(|place| allowed(place));
        let (places, finger) = worst.find_map(at).unwrap_or((CONTACT, any));
        let name = fault_case.fault.to_string();
        let draw = stream_seed(seed, &format!("five fingers {name}"));
        Self {
            finger: (!is_shared(&fault_case.fault)).then_some(finger),
            places,
            t_s: places[finger].injection_point(draw, true).t_s,
            fault_case,
            seed,
        }
    }

    /// The fault and its finger.
    pub fn name(&self) -> String {
        match self.finger {
            Some(finger) => format!("finger {finger}: {}", self.fault_case.fault),
            None => format!("all: {}", self.fault_case.fault),
        }
    }

    /// The scenes with the fault, or without it until `end_s`.
    fn scenes(&self, fault_free_until: Option<f64>) -> anyhow::Result<[Scene; FINGERS]> {
        let scene = |finger: usize| {
            let point = self.point(finger);
            let has_fault = match (self.finger, self.fault_case.fault) {
                _ if fault_free_until.is_some() => false,
                (Some(broken), _) => finger == broken,
                // Processor and host are one for all fingers; silence and garbage come from all simulated hosts.
                (None, InjectedFault::Processor(_)) => finger == 0,
                (None, InjectedFault::Hardware(fault)) => {
                    finger == 0 || !is_of_one_host(fault.kind)
                }
                (None, _) => true,
            };
            let fault = [(self.fault_case.fault, point.t_s)];
            let faults = if has_fault { &fault[..] } else { &[] };
            let after_s = fault_free_until.map_or(AFTER_S, |end_s| end_s - point.t_s);
            let seed = stream_seed(self.seed, &format!("finger {finger}")) >> 1;
            let nominal = (&DrawnDevice::nominal(seed), &Touch::default());
            let text = scene_text(faults, point, after_s, nominal);
            let mut scene = Scene::parse(&text, Path::new(point.scene.name()))?;
            let floods = |fault: &&mut ScheduledFault| is_of_one_host(fault.fault.kind);
            for flood in scene.faults.iter_mut().filter(floods) {
                flood.until_s = flood.t_s + FLOOD_S;
            }
            Ok(scene)
        };
        let scenes: anyhow::Result<Vec<_>> = (0..FINGERS).map(scene).collect();
        scenes?.try_into().ok().context("a scene for each finger")
    }

    const fn point(&self, finger: usize) -> InjectionPoint {
        InjectionPoint { scene: self.places[finger], t_s: self.t_s }
    }

    /// Runs the case on five fingers and assesses each finger that has the fault; no assessment if the fault does not apply
    /// to the engine.
    ///
    /// # Errors
    /// A scene is not valid.
    pub fn run(
        &self,
        device: &dyn FiveFingerRunner,
        references: &[Reference],
    ) -> anyhow::Result<Vec<FaultRun>> {
        let mut of_places = references.iter();
        let reference = of_places
            .find(|reference| reference.places == self.places)
            .context("a run without a fault")?;
        let assessed = |finger: usize, assessment| FaultRun {
            place: self.places[finger].name(),
            finger: Some(finger),
            t_s: self.t_s,
            assessment,
        };
        let results = match device.run_five(&self.scenes(None)?) {
            Ok(results) => results,
            Err(error) => match error.downcast_ref() {
                Some(NotInjected::NotApplicable { .. }) => return Ok(Vec::new()),
                // The behaviour of the hardware is unknown then, so the run counts as a breach.
                _ => {
                    let ended = RunAssessment::ended(&error);
                    return Ok(vec![assessed(self.finger.unwrap_or(0), ended)]);
                }
            },
        };
        let broken = |finger: &usize| self.finger.is_none_or(|broken| broken == *finger);
        let disturbed = (0..FINGERS)
            .filter(|finger| !broken(finger))
            .any(|finger| !goes_on(&results[finger].0, &reference.rows[finger], self.t_s));
        let assess = |finger: usize| {
            let (outcome, figures): &(Outcome, Figures) = &results[finger];
            let rows = with_held_telemetry(outcome.trace.rows());
            let (case, point) = (&self.fault_case, self.point(finger));
            let fault_free = &reference.rows[finger];
            let mut assessment =
                RunAssessment::new(case, point, outcome, &rows, figures, fault_free);
            if disturbed {
                assessment.breaches.push(Breach::Others);
            }
            assessed(finger, assessment)
        };
        Ok((0..FINGERS).filter(broken).map(assess).collect())
    }

    /// Summary of its assessments.
    pub fn summary(&self, trials: Vec<FaultRun>) -> FaultSummary {
        FaultSummary { fault: self.name(), ..FaultSummary::new(&self.fault_case, trials) }
    }
}

/// The scenes of some runs without a fault, as long as the longest of them.
#[derive(Debug)]
pub struct Reference {
    places: [FaultScene; FINGERS],
    rows: Vec<Vec<TraceRow>>,
}

impl Reference {
    /// The fault-free runs that `runs` need: each as the first of the runs that share it, and its end, s.
    pub fn needed(runs: &[FiveFingerRun]) -> Vec<(&FiveFingerRun, f64)> {
        let mut needed: Vec<(&FiveFingerRun, f64)> = Vec::new();
        for run in runs {
            let end_s = run.t_s + AFTER_S;
            match (needed.iter_mut()).find(|(known, _)| known.places == run.places) {
                Some((_, until_s)) => *until_s = until_s.max(end_s),
                None => needed.push((run, end_s)),
            }
        }
        needed
    }

    /// Runs the scenes of a run without its fault until `end_s`.
    ///
    /// # Errors
    /// A scene is not valid, or the device stopped.
    pub fn run(
        device: &dyn FiveFingerRunner,
        (run, end_s): (&FiveFingerRun, f64),
    ) -> anyhow::Result<Self> {
        let results = device.run_five(&run.scenes(Some(end_s))?)?;
        let rows = results.iter();
        Ok(Self {
            places: run.places,
            rows: rows.map(|(outcome, _)| with_held_telemetry(outcome.trace.rows())).collect(),
        })
    }
}

/// Whether a finger renders as without the fault, and is not off at the end.
fn goes_on(outcome: &Outcome, fault_free: &[TraceRow], t_s: f64) -> bool {
    let rows = outcome.trace.rows();
    let differs =
        |(row, sound): (&TraceRow, &TraceRow)| (row.skin_c - sound.skin_c).abs() > OTHERS_K;
    rows.len() <= fault_free.len()
        && !rows.iter().zip(fault_free).any(differs)
        && works_at_end(outcome, t_s)
}

/// The rows with the telemetry of the last tick that was reported: five fingers stream every [`STREAM_MS`] only, and what is
/// demanded in between is close to that.
fn with_held_telemetry(rows: &[TraceRow]) -> Vec<TraceRow> {
    let mut last = (0, None);
    let held = rows.iter().enumerate().map(|(i, row)| {
        if row.device.is_some() {
            last = (i, row.device);
        }
        let device = last.1.filter(|_| i - last.0 < STREAM_MS as usize);
        TraceRow { device, ..row.clone() }
    });
    held.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_sim::NativeRunner;

    fn runs(kinds: &[&str]) -> Vec<FiveFingerRun> {
        let mut cases = five_finger_cases();
        cases.retain(|case| kinds.contains(&case.fault.kind().as_str()));
        FiveFingerRun::all(cases, 1)
    }

    fn breaches(run: &FiveFingerRun) -> Vec<Vec<Breach>> {
        let references: Vec<_> = (Reference::needed(std::slice::from_ref(run)).into_iter())
            .map(|needed| Reference::run(&NativeRunner, needed).expect("runs"))
            .collect();
        let trials = run.run(&NativeRunner, &references).expect("runs");
        let breaches = trials.into_iter().map(|trial| trial.assessment.breaches);
        breaches.collect()
    }

    /// A hung core stops all fingers; taken for a fault of one finger it disturbs the others.
    #[test]
    fn a_fault_that_stops_the_other_fingers_is_a_breach() {
        let [run] = &mut runs(&["hung-core"])[..] else {
            panic!("one case");
        };
        assert_eq!(breaches(run), [(); FINGERS].map(|()| Vec::new()));
        run.finger = Some(1);
        // The engine injects it once, whichever scene has it.
        assert_eq!(breaches(run), [[Breach::Others]]);
    }

    #[test]
    fn the_finger_with_the_fault_must_name_a_right_reason() {
        let [run] = &mut runs(&["bridge-shorted"])[..] else {
            panic!("one case");
        };
        assert_ne!(run.finger, Some(0));
        assert_eq!(breaches(run), [[]]);
        run.fault_case.expected = crate::faults::ExpectedReaction::Trip(&[]);
        assert_eq!(breaches(run), [[Breach::Reason]]);
    }

    #[test]
    fn every_finger_but_the_first_has_faults_of_its_own() {
        let runs = FiveFingerRun::all(five_finger_cases(), 1);
        for finger in 0..FINGERS {
            let of_finger = runs.iter().filter(|run| run.finger == Some(finger)).count();
            assert_eq!(of_finger == 0, finger == 0, "finger {finger}");
        }
    }
}

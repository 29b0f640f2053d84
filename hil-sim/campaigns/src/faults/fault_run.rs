//! A run of one fault case.

use std::path::Path;

use serde::Serialize;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::Figures;
use thermal_sim::processor::NotInjected;
use thermal_sim::run::Outcome;
use thermal_sim::scene::{FaultKind, Scene, ScheduledFault};

use super::assessment::RunAssessment;
use super::{DrawnDevice, FaultCase, InjectedFault, InjectionPoint, Touch, scene_text};

/// Questions at the end and their times before it, s. The state is queried twice because a reset can truncate a line of
/// telemetry, which then merges with the first answer.
const QUESTIONS: [(f64, &str); 2] = [(0.2, "state"), (0.1, "state")];

/// The same about the finger, if there is a heat-flux sensor.
const KNOWLEDGE_QUESTION: (f64, &str) = (0.3, "flux");

/// Runs a scene; `None` if the fault does not apply to the engine.
fn run_if_applicable(
    device: &dyn SceneRunner,
    scene: &Scene,
) -> anyhow::Result<Option<(Outcome, Figures)>> {
    match device.run(scene) {
        Err(error) => match error.downcast_ref() {
            Some(NotInjected::NotApplicable { .. }) => Ok(None),
            _ => Err(error),
        },
        Ok(result) => Ok(Some(result)),
    }
}

/// The run of the scene without the fault, if a symptom or a comparison needs it; or with a heat-flux sensor from
/// which nothing is learnt.
fn fault_free_run(
    device: &dyn SceneRunner,
    fault_case: &FaultCase,
    point: InjectionPoint,
    scene: &Scene,
) -> anyhow::Result<Option<Outcome>> {
    let mut fault_free = scene.clone();
    let needed = scene.commissioned
        && point.scene.has_tuned_model()
        && fault_case.symptoms.iter().any(|sign| sign.needs_fault_free_run());
    match fault_case.fault {
        _ if fault_case.learning.is_some_and(|one| one.assumes) => {
            fault_free.injections.clear();
            fault_free.faults = vec![ScheduledFault {
                fault: FaultKind::FluxOpen.into(),
                t_s: 0.0,
                until_s: f64::INFINITY,
            }];
        }
        InjectedFault::Hardware(broken)
            if needed || fault_case.unchanged || fault_case.learning.is_some() =>
        {
            fault_free.faults.retain(|fault| fault.fault.kind != broken.kind);
        }
        InjectedFault::HostLine(lines) if fault_case.unchanged => {
            // The scene may have the same lines at another time.
            (fault_free.host).retain(|host| {
                host.t_s != point.t_s || scene_text::host_lines(lines).all(|line| line != host.line)
            });
        }
        _ => return Ok(None),
    }
    let (outcome, _) = device.run(&fault_free)?;
    Ok(Some(outcome))
}

/// Result of a run of one fault case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRun {
    /// Name of the scene.
    pub place: &'static str,
    /// The finger, if it is one of five.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finger: Option<usize>,
    /// Time of the fault, s.
    pub t_s: f64,
    /// Assessment of the run.
    #[serde(flatten)]
    pub assessment: RunAssessment,
}

impl FaultRun {
    /// Runs a fault case on the nominal device, whose converter has this seed; `None` if the fault does not apply to the engine.
    ///
    /// # Errors
    /// The scene is not valid.
    pub fn run(
        device: &dyn SceneRunner,
        fault_case: &FaultCase,
        point: InjectionPoint,
        seed: u64,
    ) -> anyhow::Result<Option<Self>> {
        let nominal = (&DrawnDevice::nominal(seed), &fault_case.touch(seed));
        Self::run_on(device, fault_case, point, nominal)
    }

    /// Runs a fault case on a drawn device under a drawn finger; `None` if the fault does not apply to the engine.
    pub(super) fn run_on(
        device: &dyn SceneRunner,
        fault_case: &FaultCase,
        point: InjectionPoint,
        drawn: (&DrawnDevice, &Touch),
    ) -> anyhow::Result<Option<Self>> {
        let fault = [(fault_case.fault, point.t_s)];
        let text = scene_text(&fault, point, fault_case.after_s, drawn);
        Self::run_text(device, fault_case, point, &text)
    }

    /// Whether the run broke no limit.
    pub fn holds(&self) -> bool {
        self.assessment.breaches.is_empty()
    }

    /// Runs a fault case with the text of its scene.
    pub(super) fn run_text(
        device: &dyn SceneRunner,
        fault_case: &FaultCase,
        point: InjectionPoint,
        text: &str,
    ) -> anyhow::Result<Option<Self>> {
        let scene = Scene::parse(text, Path::new(point.scene.name()))?;
        let assessment = match run_if_applicable(device, &scene) {
            Ok(None) => return Ok(None),
            Ok(Some((outcome, figures))) => {
                let fault_free = fault_free_run(device, fault_case, point, &scene)?;
                let fault_free: &[_] =
                    fault_free.as_ref().map_or(&[], |outcome| outcome.trace.rows());
                let rows = outcome.trace.rows();
                RunAssessment::new(fault_case, point, &outcome, rows, &figures, fault_free)
            }
            // The behaviour of the hardware is unknown then, so the run counts as a breach.
            Err(error) => RunAssessment::ended(&error),
        };
        Ok(Some(Self { place: point.scene.name(), finger: None, t_s: point.t_s, assessment }))
    }
}

/// The text of the scene with faults at their times, s, and with the questions at the end.
pub(super) fn scene_text(
    faults: &[(InjectedFault, f64)],
    point: InjectionPoint,
    after_s: f64,
    (device, touch): (&DrawnDevice, &Touch),
) -> String {
    let (mut text, end_s) = point.scene.text(device, point.t_s, after_s, touch);
    for (fault, t_s) in faults {
        text += &scene_text::fault_text(fault, *t_s);
    }
    let asked = touch.has_flux_sensor().then_some(KNOWLEDGE_QUESTION);
    for (before_s, line) in asked.into_iter().chain(QUESTIONS) {
        text += &scene_text::host_line(line, end_s - before_s);
    }
    text += "[plant]\n";
    text += &touch.plant;
    text += &device.plant_keys();
    text
}

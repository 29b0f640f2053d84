//! One run of one fault.

use std::path::Path;

use serde::Serialize;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::Figures;
use thermal_sim::processor::NotInjected;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::assessment::RunAssessment;
use super::{FaultCase, FaultScene, InjectedFault, InjectionPoint, scene_text};

/// What is asked at the end, and how long before it, s. Twice: a reset tears a line of telemetry, which the first answer
/// then ends.
const QUESTIONS: [(f64, &str); 2] = [(0.2, "state"), (0.1, "state")];

/// Runs a scene; none if the engine has no part that could fail so.
fn ran(device: &dyn SceneRunner, scene: &Scene) -> anyhow::Result<Option<(Outcome, Figures)>> {
    match device.run(scene) {
        // Only the native engine has no processor.
        Err(error) => match error.downcast_ref() {
            Some(NotInjected::NotApplicable { .. }) => Ok(None),
            _ => Err(error),
        },
        Ok(ran) => Ok(Some(ran)),
    }
}

/// A scene without the fault, if a sign of it needs that, and can be there.
fn sound(
    device: &dyn SceneRunner,
    fault_case: &FaultCase,
    place: FaultScene,
    scene: &Scene,
) -> anyhow::Result<Option<Outcome>> {
    let mut sound = scene.clone();
    let needed = place.has_tuned_model()
        && fault_case
            .symptoms
            .iter()
            .any(|sign| sign.needs_fault_free_run());
    match fault_case.fault {
        InjectedFault::Hardware(broken) if needed => {
            sound.faults.retain(|fault| fault.fault.kind != broken.kind);
        }
        _ => return Ok(None),
    }
    let (outcome, _) = device.run(&sound)?;
    Ok(Some(outcome))
}

/// One run of one fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRun {
    /// The scene.
    pub place: &'static str,
    /// When the fault came, s.
    pub t_s: f64,
    /// What came of it.
    #[serde(flatten)]
    pub assessment: RunAssessment,
}

impl FaultRun {
    /// Runs a fault case at a moment; none if the engine has no part that could fail so.
    ///
    /// # Errors
    /// The scene cannot be.
    pub fn run(
        device: &dyn SceneRunner,
        fault_case: &FaultCase,
        moment: InjectionPoint,
        seed: u64,
    ) -> anyhow::Result<Option<Self>> {
        let text = scene_text(
            &[(fault_case.fault, moment.t_s)],
            moment,
            fault_case.after_s,
            seed,
            &[],
        );
        Self::of_text(device, fault_case, moment, &text)
    }

    /// Whether the run broke no limit.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.assessment.breaches.is_empty()
    }

    /// The same in a scene that is given as a file has it.
    pub(super) fn of_text(
        device: &dyn SceneRunner,
        fault_case: &FaultCase,
        moment: InjectionPoint,
        text: &str,
    ) -> anyhow::Result<Option<Self>> {
        let scene = Scene::parse(text, Path::new(moment.place.name()))?;
        let assessment = match ran(device, &scene) {
            Ok(None) => return Ok(None),
            Ok(Some((outcome, figures))) => {
                let sound = sound(device, fault_case, moment.place, &scene)?;
                let sound: &[_] = sound.as_ref().map_or(&[], |sound| sound.trace.rows());
                RunAssessment::of(fault_case, moment, &outcome, &figures, sound)
            }
            // Nobody knows what silicon would do then: that proves nothing, so it counts as a breach.
            Err(error) => RunAssessment::ended(&error),
        };
        Ok(Some(Self {
            place: moment.place.name(),
            t_s: moment.t_s,
            assessment,
        }))
    }
}

/// The place's scene as a file has it, with faults at their times, s, and with what the host asks in the end; `plant` are
/// keys of the parameter box. The seed is that of the converter.
pub(super) fn scene_text(
    faults: &[(InjectedFault, f64)],
    moment: InjectionPoint,
    after_s: f64,
    seed: u64,
    plant: &[(String, f64)],
) -> String {
    let (mut text, end_s) = moment.place.text(seed, moment.t_s, after_s);
    for (fault, t_s) in faults {
        text += &scene_text::fault_text(fault, *t_s);
    }
    for (before_s, line) in QUESTIONS {
        text += &scene_text::host_line(line, end_s - before_s);
    }
    if !plant.is_empty() {
        text += "[plant]\n";
    }
    for (key, value) in plant {
        text += &format!("{key} = {value:?}\n");
    }
    text
}

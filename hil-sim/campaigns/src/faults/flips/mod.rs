//! Single bit flips of the running image: scene, bit and time drawn by seed and number.
//!
//! ```text
//! every scene once without a flip -> reference (trace, stack use)
//! number -> region -> byte of RAM or register -> bit, at a microsecond of a scene
//!        -> scene with the flip in it -> image -> assessment, comparison with the reference -> effect
//! ```
//!
//! A flip has no symptom of its own. Every run is checked for the skin temperature, the dose, and current later than 50 ms
//! after a symptom that any device must detect.

mod bit_flip;
mod effect;
mod region;
mod table;

use anyhow::Context;
use serde::Serialize;

pub use bit_flip::BitFlip;
pub use effect::FlipEffect;
pub use region::{FlipRegion, FlippableMemory};
pub use table::flip_table;

use super::{
    Breach, DrawnDevice, ExpectedReaction, FaultCase, FaultScene, InjectedFault, InjectionPoint,
    RunAssessment, Symptom, Touch, fault_run,
};
use thermal_sim::SceneRunner;
use thermal_sim::processor::NotInjected;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

/// Scenes of the flips: the finger touches the display early, or the self-test drives the display.
const PLACES: [FaultScene; 10] = [
    FaultScene::Slew,
    FaultScene::Copper,
    FaultScene::Granite,
    FaultScene::Foam,
    FaultScene::Warm,
    FaultScene::Cold,
    FaultScene::Touched,
    FaultScene::Replace,
    FaultScene::SelfTest,
    FaultScene::Off,
];
/// Duration of the range of flips within a scene, s, and of the rest of the scene, s.
const WITHIN_S: f64 = 2.0;
const WATCHED_S: f64 = 3.0;
/// Seed of the converter, equal for all runs so that they can be compared with their references.
const CONVERTER: u64 = 1;

/// Symptoms that any device must detect, whatever their cause.
const SIGNS: &[Symptom] = &[
    Symptom::OverCurrent,
    Symptom::CurrentOff,
    Symptom::WrongWay,
    Symptom::DisplayLimit,
    Symptom::FaultLine,
];

fn text(place: FaultScene, flip: &[(InjectedFault, f64)]) -> String {
    let (_, to_s) = bit_flip::span(place);
    let end = InjectionPoint { scene: place, t_s: to_s };
    let nominal = (&DrawnDevice::nominal(CONVERTER), &Touch::default());
    fault_run::scene_text(flip, end, WATCHED_S, nominal)
}

/// The run of a scene without a flip.
#[derive(Debug)]
pub struct ReferenceRun {
    place: FaultScene,
    outcome: Outcome,
}

impl ReferenceRun {
    /// Every scene of the flips.
    pub const PLACES: [FaultScene; PLACES.len()] = PLACES;

    /// Runs a scene on an image.
    ///
    /// # Errors
    /// The image does not run.
    pub fn new(device: &dyn SceneRunner, place: FaultScene) -> anyhow::Result<Self> {
        let scene = Scene::parse(&text(place, &[]), place.name().as_ref())?;
        let (outcome, _) = device.run(&scene)?;
        Ok(Self { place, outcome })
    }

    /// Largest stack use, bytes.
    pub fn stack_bytes(&self) -> Option<u32> {
        self.outcome.cost?.stack_bytes
    }
}

impl BitFlip {
    /// Text of the scene.
    pub fn text(&self) -> String {
        text(self.point.scene, &[(self.injected(), self.point.t_s)])
    }

    /// Runs the flip on an image.
    ///
    /// # Errors
    /// The scene is not valid, or there is no reference for it.
    pub fn run(
        &self,
        device: &dyn SceneRunner,
        references: &[ReferenceRun],
    ) -> anyhow::Result<FlipResult> {
        let place = self.point.scene;
        let reference = (references.iter().find(|reference| reference.place == place))
            .with_context(|| format!("no reference of {}", place.name()))?;
        let scene = Scene::parse(&self.text(), place.name().as_ref())?;
        let fault_case = FaultCase {
            fault: self.injected(),
            symptoms: SIGNS,
            expected: ExpectedReaction::Trip(&[]),
            latent: false,
            unchanged: false,
            learning: None,
            scenes: &[],
            never_at: &[],
            after_s: WATCHED_S,
        };
        let (class, assessment, deviation_k) = match device.run(&scene) {
            Ok((outcome, figures)) => {
                let rows = outcome.trace.rows();
                let mut assessment =
                    RunAssessment::new(&fault_case, self.point, &outcome, rows, &figures, &[]);
                // Any trip cause is correct.
                assessment.breaches.retain(|breach| *breach != Breach::Reason);
                let class = FlipEffect::of(&assessment, &outcome, &reference.outcome);
                (class, assessment, Some(effect::deviation_k(&outcome, &reference.outcome)))
            }
            Err(error) => {
                let class = match error.downcast_ref() {
                    Some(NotInjected::Refused { .. }) => FlipEffect::Refused,
                    _ => FlipEffect::Ended,
                };
                (class, RunAssessment::ended(&error), None)
            }
        };
        Ok(FlipResult {
            number: self.number,
            region: self.region,
            flip: self.fault.to_string(),
            class,
            deviation_k,
            place: place.name(),
            t_s: self.point.t_s,
            assessment,
        })
    }
}

/// Result of a flip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlipResult {
    /// Number of the flip.
    pub number: u64,
    /// Region of the bit.
    pub region: FlipRegion,
    /// The bit.
    pub flip: String,
    /// Effect on the device and the finger.
    pub class: FlipEffect,
    /// Largest deviation of the display temperature from the reference, K; `None` if the run ended early.
    pub deviation_k: Option<f64>,
    /// Name of the scene.
    pub place: &'static str,
    /// Time of the flip, s.
    pub t_s: f64,
    /// Assessment of the run.
    #[serde(flatten)]
    pub assessment: RunAssessment,
}

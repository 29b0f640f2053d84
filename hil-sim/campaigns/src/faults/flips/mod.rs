//! Single bit flips of the running image: place, bit and moment by seed and number.
//!
//! ```text
//! every place once without a flip -> reference (trace, stack that is used)
//! number -> region -> byte of RAM or register -> bit, at a microsecond of a place
//!        -> scene with the flip in it -> image -> assessment and trace against the reference -> class
//! ```
//!
//! A flip has no sign of its own, so what counts is what no flip may do: the skin's range, the dose, and current from
//! 50 ms after a deviation that any device must notice.

mod bit_flip;
mod effect;
mod region;
mod registers;
mod table;

use anyhow::Context;
use serde::Serialize;

pub use bit_flip::BitFlip;
pub use effect::FlipEffect;
pub use region::{FlipRegion, FlippableMemory};
pub use table::flip_table;

use super::{
    Breach, FaultScene, InjectedFault, InjectionPoint, RunAssessment, Symptom, fault_case,
    fault_run,
};
use thermal_sim::SceneRunner;
use thermal_sim::processor::NotInjected;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

/// Where flips happen: the finger is on the display early, or the self-test drives it.
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
/// Flips come in the first part of a place's time, s, and are watched for so long, s, from its end on.
const WITHIN_S: f64 = 2.0;
const WATCHED_S: f64 = 3.0;
/// Seed of the converter: the same everywhere, or no run could be compared with its reference.
const CONVERTER: u64 = 1;

/// What any device must notice, whatever the cause.
const SIGNS: &[Symptom] = &[
    Symptom::OverCurrent,
    Symptom::CurrentOff,
    Symptom::WrongWay,
    Symptom::DisplayLimit,
    Symptom::FaultLine,
];

fn text(place: FaultScene, flip: &[(InjectedFault, f64)]) -> String {
    let (_, to_s) = bit_flip::span(place);
    let end = InjectionPoint {
        scene: place,
        t_s: to_s,
    };
    fault_run::scene_text(flip, end, WATCHED_S, CONVERTER, &[])
}

/// A place without a flip.
#[derive(Debug)]
pub struct ReferenceRun {
    place: FaultScene,
    outcome: Outcome,
}

impl ReferenceRun {
    /// Every place where flips happen.
    pub const PLACES: [FaultScene; PLACES.len()] = PLACES;

    /// Runs a place on an image.
    ///
    /// # Errors
    /// The image does not run.
    pub fn new(device: &dyn SceneRunner, place: FaultScene) -> anyhow::Result<Self> {
        let scene = Scene::parse(&text(place, &[]), place.name().as_ref())?;
        let (outcome, _) = device.run(&scene)?;
        Ok(Self { place, outcome })
    }

    /// Most of the stack that was used, bytes.
    #[must_use]
    pub fn stack_bytes(&self) -> Option<u32> {
        self.outcome.cost?.stack_bytes
    }
}

impl BitFlip {
    /// Its scene as a file has it.
    #[must_use]
    pub fn text(&self) -> String {
        text(self.point.scene, &[(self.injected(), self.point.t_s)])
    }

    /// Runs it on an image.
    ///
    /// # Errors
    /// The scene cannot be, or none of the references is of its place.
    pub fn run(
        &self,
        device: &dyn SceneRunner,
        references: &[ReferenceRun],
    ) -> anyhow::Result<FlipResult> {
        let place = self.point.scene;
        let reference = (references.iter().find(|reference| reference.place == place))
            .with_context(|| format!("no reference of {}", place.name()))?;
        let scene = Scene::parse(&self.text(), place.name().as_ref())?;
        let fault_case = fault_case::trips(self.injected(), SIGNS, &[]);
        let (class, assessment, deviation_k) = match device.run(&scene) {
            Ok((outcome, figures)) => {
                let mut assessment =
                    RunAssessment::new(&fault_case, self.point, &outcome, &figures, &[]);
                // Any word is right.
                assessment
                    .breaches
                    .retain(|breach| *breach != Breach::Reason);
                let class = FlipEffect::of(&assessment, &outcome, &reference.outcome);
                (
                    class,
                    assessment,
                    Some(effect::deviation_k(&outcome, &reference.outcome)),
                )
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

/// What came of a flip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlipResult {
    /// Its number.
    pub number: u64,
    /// Where it was.
    pub region: FlipRegion,
    /// The bit.
    pub flip: String,
    /// What it was for the finger.
    pub class: FlipEffect,
    /// Most that the display was off its reference, K; none if the run has none.
    pub deviation_k: Option<f64>,
    /// The scene.
    pub place: &'static str,
    /// When, s.
    pub t_s: f64,
    /// In figures.
    #[serde(flatten)]
    pub assessment: RunAssessment,
}

//! Runs of scenes on five fingers, for campaigns.

use std::time::Instant;

use anyhow::Context;

use super::{FINGERS, FiveFingerEngine, NativeFiveFingers, run};
use crate::metrics::{Figures, figures};
use crate::run::{Outcome, RunError};
use crate::scene::Scene;
use crate::{NativeRunner, World};

/// Runs scenes on five fingers, each time on a new device.
pub trait FiveFingerRunner: Sync {
    /// Runs a scene on each finger from power-up to the end of the longest.
    ///
    /// # Errors
    /// A plant cannot be built, the device stopped, or it refused a scene. A fault of the processor that was not injected is
    /// a [`NotInjected`](crate::processor::NotInjected).
    fn run_five(&self, scenes: &[Scene; FINGERS]) -> anyhow::Result<Vec<(Outcome, Figures)>>;
}

impl FiveFingerRunner for NativeRunner {
    fn run_five(&self, scenes: &[Scene; FINGERS]) -> anyhow::Result<Vec<(Outcome, Figures)>> {
        run_scenes_on(scenes, |worlds| Ok(NativeFiveFingers::new(worlds)))
    }
}

/// Runs scenes on the engine that `start` creates in their worlds, for implementations of [`FiveFingerRunner::run_five`].
///
/// # Errors
/// As [`FiveFingerRunner::run_five`].
pub fn run_scenes_on<E: FiveFingerEngine>(
    scenes: &[Scene; FINGERS],
    start: impl FnOnce([World; FINGERS]) -> anyhow::Result<E>,
) -> anyhow::Result<Vec<(Outcome, Figures)>> {
    let began = Instant::now();
    let worlds: Vec<_> =
        (scenes.iter().map(World::of_five_fingers)).collect::<Result<_, _>>().context("plant")?;
    let worlds: [World; FINGERS] = (worlds.try_into()).ok().context("one world for a scene")?;
    let outcomes = run(scenes, &mut start(worlds)?, |_| ()).map_err(|error| match error {
        RunError::NotInjected(error) => anyhow::Error::from(error),
        error => error.into(),
    })?;
    let with_figures = |(scene, mut outcome): (&Scene, Outcome)| {
        outcome.clock.began = began;
        let figures = figures(scene, &outcome);
        (outcome, figures)
    };
    Ok(scenes.iter().zip(outcomes).map(with_figures).collect())
}

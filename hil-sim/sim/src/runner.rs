//! Runs of whole scenes on a device, for campaigns.

use std::ops::Range;
use std::time::Instant;

use anyhow::Context;

use crate::World;
use crate::engine::{Engine, NativeEngine};
use crate::metrics::{Figures, figures};
use crate::run::{Outcome, RunError, run};
use crate::scene::Scene;

/// Runs scenes, each on a new device.
pub trait SceneRunner: Sync {
    /// Name of the engine on the command line.
    fn name(&self) -> &'static str;

    /// Runs a scene from power-up to its end.
    ///
    /// # Errors
    /// The plant cannot be built, the device stopped, or it refused the scene. A fault of the processor that was not
    /// injected is a [`NotInjected`](crate::processor::NotInjected).
    fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)>;

    /// Whether the engine has a processor, in which faults can be injected.
    fn has_processor(&self) -> bool {
        false
    }

    /// Layout of the program's data in the RAM.
    ///
    /// # Errors
    /// The engine has no RAM, or the image does not define the layout.
    fn ram_layout(&self) -> anyhow::Result<RamLayout> {
        anyhow::bail!("engine {} has no RAM", self.name())
    }
}

/// Address ranges of an image's data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RamLayout {
    /// The whole RAM.
    pub ram: Range<u32>,
    /// Static data, including what survives a reset.
    pub statics: Range<u32>,
    /// Initial stack pointer; the stack grows down.
    pub stack_top: u32,
}

/// Runs scenes on the native engine.
#[derive(Clone, Copy, Debug)]
pub struct NativeRunner;

impl SceneRunner for NativeRunner {
    fn name(&self) -> &'static str {
        NativeEngine::NAME
    }

    fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)> {
        run_scene_on(scene, |world| Ok(NativeEngine::new(world)))
    }
}

/// Runs a scene on the engine that `start` creates in the scene's world, for implementations of [`SceneRunner::run`].
///
/// # Errors
/// As [`SceneRunner::run`].
pub fn run_scene_on<E: Engine>(
    scene: &Scene,
    start: impl FnOnce(World) -> anyhow::Result<E>,
) -> anyhow::Result<(Outcome, Figures)> {
    let began = Instant::now();
    let world = World::new(scene).context("plant")?;
    let mut outcome = run(scene, &mut start(world)?, |_| ()).map_err(|error| match error {
        RunError::NotInjected(error) => anyhow::Error::from(error),
        error => error.into(),
    })?;
    outcome.clock.began = began;
    let figures = figures(scene, &outcome);
    Ok((outcome, figures))
}

//! Devices on which campaigns run one scene after the other.

use std::ops::Range;

use anyhow::Context;

use crate::World;
use crate::engine::{Engine, NativeEngine};
use crate::metrics::{Figures, figures};
use crate::run::{Outcome, RunError, run};
use crate::scene::Scene;

/// A kind of device; each scene is run on a new one.
pub trait SceneRunner: Sync {
    /// Name of its engine, as the command line has it.
    fn name(&self) -> &'static str;

    /// Runs a scene from power-up to its end.
    ///
    /// # Errors
    /// The plant cannot be built, the device stopped, or it refused the scene. A fault of the processor that was not
    /// injected is a [`NotInjected`](crate::processor::NotInjected).
    fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)>;

    /// Whether it has a processor, whose parts can fail.
    fn has_processor(&self) -> bool {
        false
    }

    /// Where its program keeps what in the RAM.
    ///
    /// # Errors
    /// It has no RAM, or the image does not say.
    fn ram_layout(&self) -> anyhow::Result<RamLayout> {
        anyhow::bail!("engine {} has no RAM", self.name())
    }
}

/// Where an image keeps what: addresses of bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RamLayout {
    /// All of the RAM.
    pub ram: Range<u32>,
    /// Static data, what resets keep included.
    pub statics: Range<u32>,
    /// Where the stack begins, which grows down.
    pub stack_top: u32,
}

/// The device's logic, called directly.
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

/// Runs a scene on the engine that is started in its world, as [`SceneRunner::run`] does.
///
/// # Errors
/// As [`SceneRunner::run`].
pub fn run_scene_on<E: Engine>(
    scene: &Scene,
    start: impl FnOnce(World) -> anyhow::Result<E>,
) -> anyhow::Result<(Outcome, Figures)> {
    let world = World::new(scene).context("plant")?;
    let outcome = run(scene, &mut start(world)?, |_| ()).map_err(|error| match error {
        RunError::NotInjected(error) => anyhow::Error::from(error),
        error => error.into(),
    })?;
    let figures = figures(scene, &outcome);
    Ok((outcome, figures))
}

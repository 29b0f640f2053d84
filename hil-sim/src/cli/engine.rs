//! The engine and the scene of a command.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, anyhow};
use clap::ValueEnum;
#[cfg(feature = "emulator")]
use stm32_emulator::FiveFingerBoard;
use thermal_sim::engine::{Engine, NativeEngine};
#[cfg(feature = "emulator")]
use thermal_sim::five_fingers::FINGERS;
use thermal_sim::five_fingers::{FiveFingerEngine, FiveFingerRunner, NativeFiveFingers};
use thermal_sim::metrics::{Figures, figures};
use thermal_sim::processor::Injection;
use thermal_sim::run::{Outcome, run_with};
use thermal_sim::scene::Scene;
use thermal_sim::{NativeRunner, SceneRunner, World};

#[cfg(feature = "emulator")]
use super::image;
use super::{Failure, output};

/// What runs the device's logic.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EngineKind {
    /// The release image in the emulated microcontroller
    #[cfg(feature = "emulator")]
    Image,
    /// The same logic, called directly: faster, without cost figures
    Native,
}

impl EngineKind {
    /// Default engine: the image, if this build can run it.
    #[cfg(feature = "emulator")]
    pub const DEFAULT: Self = Self::Image;
    /// Default engine: the only one of this build.
    #[cfg(not(feature = "emulator"))]
    pub const DEFAULT: Self = Self::Native;
}

/// The runner of a campaign.
pub fn runner(kind: EngineKind, elf: Option<&Path>) -> Result<Box<dyn SceneRunner>, Failure> {
    match kind {
        #[cfg(feature = "emulator")]
        EngineKind::Image => Ok(Box::new(image::firmware(elf, 1)?.0)),
        EngineKind::Native => {
            refuse_elf(elf)?;
            Ok(Box::new(NativeRunner))
        }
    }
}

/// The runner of five fingers and the name of its engine.
pub fn five_finger_runner(
    kind: EngineKind,
    elf: Option<&Path>,
) -> Result<(Box<dyn FiveFingerRunner>, &'static str), Failure> {
    match kind {
        #[cfg(feature = "emulator")]
        EngineKind::Image => {
            let image = image::firmware(elf, FINGERS)?.0;
            Ok((Box::new(image), FiveFingerBoard::NAME))
        }
        EngineKind::Native => {
            refuse_elf(elf)?;
            Ok((Box::new(NativeRunner), NativeFiveFingers::NAME))
        }
    }
}

/// Reads a scene, and says on standard error what of it the device is not told.
pub fn read(path: &Path) -> Result<Scene, Failure> {
    let scene = Scene::read(path).map_err(Failure::input)?;
    if let Some(notice) = scene.untold_back() {
        eprintln!("hil-sim: {}: {notice}", path.display());
    }
    Ok(scene)
}

/// Reads a scene and builds its world.
pub fn scene(path: &Path) -> Result<(Scene, World), Failure> {
    let scene = read(path)?;
    let world =
        World::new(&scene).with_context(|| path.display().to_string()).map_err(Failure::input)?;
    Ok((scene, world))
}

/// Runs a scene in its world, with faults of the processor, on the engine that the command line chooses, and the image that it
/// names. The run's wait counts from `began`, without the time in which the image is built.
pub fn run_scene(
    (kind, elf): (EngineKind, Option<&Path>),
    scene: &Scene,
    world: World,
    injections: &[Injection],
    began: Instant,
) -> Result<(Outcome, Figures), Failure> {
    match kind {
        EngineKind::Native => {
            refuse_elf(elf)?;
            run_on(&mut NativeEngine::new(world), scene, injections, began)
        }
        #[cfg(feature = "emulator")]
        EngineKind::Image => {
            let (elf, began) = image::path_and_began(elf, 1, began)?;
            run_on(&mut image::engine(Some(&elf), world)?, scene, injections, began)
        }
    }
}

fn run_on<E: Engine>(
    engine: &mut E,
    scene: &Scene,
    injections: &[Injection],
    began: Instant,
) -> Result<(Outcome, Figures), Failure> {
    let name = format!("{} on engine {}", scene.object.name, E::NAME);
    let run = |progress: &dyn Fn(f64)| run_with(scene, injections, engine, progress);
    let mut outcome = output::with_progress(name, run)?.map_err(Failure::run)?;
    outcome.clock.began = began;
    let figures = figures(scene, &outcome);
    Ok((outcome, figures))
}

/// Refuses `--elf` for the native engine.
pub fn refuse_elf(elf: Option<&Path>) -> Result<(), Failure> {
    match elf {
        Some(_) => Err(Failure::input(anyhow!(
            "--elf is for --engine image; the native engine runs no image"
        ))),
        None => Ok(()),
    }
}

//! What a command runs: a scene, and the image or its logic.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::ValueEnum;
use stm32_emulator::Firmware;
use thermal_sim::scene::Scene;
use hil_sim::{World, firmware};

use super::Failure;

/// What runs the device's logic.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// The release image in the emulated microcontroller
    Image,
    /// The same logic, called directly: faster, without cost figures
    Native,
}

/// A scene and what surrounds its device.
pub fn scene(path: &Path) -> Result<(Scene, World), Failure> {
    let scene = Scene::read(path).map_err(Failure::input)?;
    let world = World::new(&scene)
        .with_context(|| path.display().to_string())
        .map_err(Failure::input)?;
    Ok((scene, world))
}

/// The image that `--elf` names, or that of the current sources for so many fingers; and where it lies.
pub fn image(elf: Option<&Path>, fingers: usize) -> Result<(Firmware, PathBuf), Failure> {
    let path = match elf {
        Some(path) => path.to_owned(),
        None => firmware::build(fingers).map_err(Failure::run)?,
    };
    let firmware = Firmware::from_file(&path)
        .with_context(|| path.display().to_string())
        .map_err(Failure::input)?;
    Ok((firmware, path))
}

/// `--elf` where no image runs is a mistake.
pub fn no_image(elf: Option<&Path>) -> Result<(), Failure> {
    match elf {
        Some(_) => Err(Failure::input(anyhow!(
            "--elf is for --engine image; the native engine runs no image"
        ))),
        None => Ok(()),
    }
}

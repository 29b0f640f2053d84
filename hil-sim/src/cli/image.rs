//! The release image in the emulated microcontroller, for commands that run it.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use stm32_emulator::{Firmware, FiveFingerBoard, OneFingerBoard, build};
use thermal_sim::World;
use thermal_sim::five_fingers::FINGERS;

use super::Failure;

/// Path of the image that `--elf` names, or of that of the current sources for a number of fingers, which is built.
fn path(elf: Option<&Path>, fingers: usize) -> Result<PathBuf, Failure> {
    match elf {
        Some(path) => Ok(path.to_owned()),
        None => build(fingers).map_err(Failure::run),
    }
}

/// [`path`], and `began` moved by the time that building the image took, for a wait that does not count it.
pub fn path_and_began(
    elf: Option<&Path>,
    fingers: usize,
    began: Instant,
) -> Result<(PathBuf, Instant), Failure> {
    let building = Instant::now();
    let path = path(elf, fingers)?;
    Ok((path, began + building.elapsed()))
}

/// The image at [`path`], and that path.
pub fn firmware(elf: Option<&Path>, fingers: usize) -> Result<(Firmware, PathBuf), Failure> {
    let path = path(elf, fingers)?;
    let firmware = Firmware::from_file(&path)
        .with_context(|| path.display().to_string())
        .map_err(Failure::input)?;
    Ok((firmware, path))
}

/// The image for one finger in a world, powered up.
pub fn engine(elf: Option<&Path>, world: World) -> Result<OneFingerBoard, Failure> {
    OneFingerBoard::new(&firmware(elf, 1)?.0, world).map_err(Failure::run)
}

/// The image for five fingers in their worlds, powered up.
pub fn five_fingers(
    elf: Option<&Path>,
    worlds: [World; FINGERS],
) -> Result<FiveFingerBoard, Failure> {
    FiveFingerBoard::new(&firmware(elf, FINGERS)?.0, worlds).map_err(Failure::run)
}

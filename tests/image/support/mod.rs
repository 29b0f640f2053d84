#![doc = include_str!("../README.md")]

mod bare;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use stm32_emulator::Firmware;
use stm32_emulator::OneFingerBoard;
use thermal_sim::World;
use thermal_sim::run::{Outcome, run};
use thermal_sim::scene::Scene;

pub use bare::{Bare, START};

/// The release image of the current sources for one finger, built once.
///
/// # Panics
/// It cannot be built.
pub fn image() -> &'static Path {
    static IMAGE: OnceLock<PathBuf> = OnceLock::new();
    IMAGE.get_or_init(|| stm32_emulator::build(1).expect("the image builds"))
}

/// Runs a scene on an image.
///
/// # Errors
/// The plant refuses the scene, or the image does not run to its end.
pub fn on(image: &Firmware, scene: &Scene) -> anyhow::Result<Outcome> {
    let mut engine = OneFingerBoard::new(image, World::new(scene)?)?;
    Ok(run(scene, &mut engine, |_| ())?)
}

/// Runs a scene on the release image.
///
/// # Panics
/// It does not run to its end.
pub fn on_image(scene: &Scene) -> Outcome {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    on(&firmware, scene).expect("the image runs to the end")
}

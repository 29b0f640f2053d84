//! What runs a case.

use anyhow::Context;

use crate::engine::{Engine, Image, Native};
use crate::machine::Firmware;
use crate::metrics::{Figures, figures};
use crate::run::{Outcome, run};
use crate::scene::Scene;
use crate::world::World;

/// The device of a campaign.
#[derive(Clone, Copy)]
pub enum Device<'a> {
    /// An image in the emulated microcontroller.
    Image(&'a Firmware),
    /// Its logic, called directly.
    Native,
}

impl Device<'_> {
    /// The engine's name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Image(_) => Image::NAME,
            Self::Native => Native::NAME,
        }
    }

    /// Runs a scene.
    ///
    /// # Errors
    /// The device stopped, or refused the scene.
    pub fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)> {
        fn on<E: Engine>(scene: &Scene, engine: &mut E) -> anyhow::Result<(Outcome, Figures)> {
            let outcome = run(scene, engine, |_| ())?;
            let figures = figures::<E>(scene, &outcome);
            Ok((outcome, figures))
        }
        let world = World::new(scene).context("plant")?;
        match self {
            Self::Image(firmware) => on(scene, &mut Image::new(firmware, world)?),
            Self::Native => on(scene, &mut Native::new(world)),
        }
    }
}

//! `hil-sim commission`: what the operator does with a device, and the settings it then has.

use std::io::{Write, stdout};
use std::path::PathBuf;

use anyhow::anyhow;
use clap::{Args, ValueEnum};
use hil_sim::commission::{Plants, commission};
use hil_sim::engine::{Image, Native};
use hil_sim::firmware;
use hil_sim::machine::Firmware;
use hil_sim::plant::{Params, parameters};
use hil_sim::scene::Scene;

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// A scene whose device is commissioned
    #[arg(conflicts_with = "draw", required_unless_present = "draw")]
    scene: Option<PathBuf>,
    /// Instead, a device of the parameter box, drawn by this seed
    #[arg(long)]
    draw: Option<u64>,
    /// Room of a drawn device, C
    #[arg(long, default_value_t = 24.0)]
    room_c: f64,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = Kind::Native)]
    engine: Kind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// The release image in the emulated microcontroller
    Image,
    /// The same logic, called directly
    Native,
}

/// Prints the settings as lines.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let plants = match (&arguments.scene, arguments.draw) {
        (Some(path), _) => {
            let scene = Scene::read(path).map_err(Failure::input)?;
            Plants::new(&scene.params, scene.room_c, scene.seed)
        }
        (None, draw) => {
            let (mut params, seed) = (Params::nominal(), draw.unwrap_or_default());
            parameters::draw(&mut params, seed);
            Plants::new(&params, arguments.room_c, seed)
        }
    };
    let world = plants.at_work().map_err(Failure::input)?;
    let lines = match arguments.engine {
        Kind::Native if arguments.elf.is_some() => {
            return Err(Failure::input(anyhow!(
                "--elf is for --engine image; the native engine runs no image"
            )));
        }
        Kind::Native => commission(&plants, &mut Native::new(world)),
        Kind::Image => {
            let path = match &arguments.elf {
                Some(path) => path.clone(),
                None => firmware::build(1).map_err(Failure::run)?,
            };
            let firmware = Firmware::from_file(&path).map_err(Failure::input)?;
            commission(&plants, &mut Image::new(&firmware, world).map_err(Failure::run)?)
        }
    };
    let text: String = (lines.map_err(Failure::run)?.iter())
        .map(|line| format!("{line}\n"))
        .collect();
    stdout().write_all(text.as_bytes()).map_err(Failure::run)
}

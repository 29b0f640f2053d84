//! `hil-sim object`: the lines that describe the object of a scene to a device.

use std::io::{Write, stdout};
use std::path::PathBuf;

use clap::Args;
use thermal_sim::host::object_lines;

use super::{Failure, engine};

/// Text after the options in the help.
const USAGE: &str = "\
The material of the scene's object, then its temperature, then, if it is no half-space, the line `object slab` for a slab of
that material, or its relaxations as an upload.

  hil-sim object scenes/copper-on-foam.toml > object.txt";

#[derive(Args)]
#[command(after_help = USAGE)]
pub struct Arguments {
    /// The scene with the object
    scene: PathBuf,
}

/// Prints the lines.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = engine::read(&arguments.scene)?;
    let lines = object_lines(&scene).join("\n");
    writeln!(stdout(), "{lines}").map_err(Failure::run)
}

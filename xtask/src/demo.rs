//! `cargo xtask demo`: a finger lands on "copper" in the emulator.
use anyhow::Result;

use crate::firmware::{self, Fingers};
use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission};
use crate::step::Steps;

const SCENE: &str = "scenes/copper.toml";
const OUT: &str = "target/demo";

/// `cargo xtask demo`
pub fn run(permission: Permission) -> Result<()> {
    let mut steps = Steps::new(4);
    let toolchain = steps.run("set-up", "", || setup::prepare(Needs::EMULATOR, permission))?;
    steps.run("building the firmware", "about 1 min the first time", || {
        firmware::build(&toolchain, Fingers::One)
    })?;
    steps.run("building the emulator", "about 2 min the first time", || {
        Invocation::cargo(["build", "--release", "-p", "hil-sim"]).run_to_stderr()
    })?;
    steps.run("running the image: a finger lands on \"copper\"", "", || {
        let run = Invocation::run_package("hil-sim", ["run", SCENE, "--out", OUT]);
        permission.choice.handed_to(run).run()
    })?;
    println!("\n{}", firmware::describe(&toolchain, Fingers::One)?);
    println!("report and trace: {}", workspace().join(OUT).display());
    Ok(())
}

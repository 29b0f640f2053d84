//! `cargo xtask demo`: a finger lands on "copper" in the emulator.
use std::thread;

use anyhow::{Result, anyhow};

use crate::firmware::{self, Fingers};
use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission};
use crate::step::Steps;

const SCENE: &str = "scenes/copper.toml";
const OUT: &str = "target/demo";

/// `cargo xtask demo`
pub fn run(permission: Permission) -> Result<()> {
    let mut steps = Steps::new(3);
    let toolchain = steps.run("set-up", "", || setup::prepare(Needs::EMULATOR, permission))?;
    // Side by side, because the image is optimised as a whole, by one core.
    steps.run("building the firmware and the emulator", "about 3 min the first time", || {
        thread::scope(|scope| {
            let image = scope.spawn(|| firmware::build(&toolchain, Fingers::One));
            let emulator =
                Invocation::cargo(["build", "--release", "-p", "hil-sim"]).run_to_stderr();
            let image = image.join().unwrap_or_else(|_| Err(anyhow!("its build panicked")));
            image.and(emulator)
        })
    })?;
    steps.run("running the image: a finger lands on \"copper\"", "", || {
        let run = Invocation::run_package("hil-sim", ["run", SCENE, "--out", OUT]);
        permission.choice.handed_to(run).run()
    })?;
    println!("\n{}", firmware::describe(&toolchain, Fingers::One)?);
    println!("report and trace: {}", workspace().join(OUT).display());
    Ok(())
}

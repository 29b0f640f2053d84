//! The image for the tests of the emulated microcontroller.
use anyhow::Result;

use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

/// `cargo xtask probe`: builds the image and prints its path.
pub fn run(permission: Permission) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    let folder = match &toolchain {
        Toolchain::Active => "target/probe",
        Toolchain::Distribution(_) => "target/probe-distribution",
    };
    build(&toolchain, folder).run_to_stderr()?;
    let elf = workspace().join(folder).join(TARGET).join("release/probe");
    println!("{}", elf.display());
    Ok(())
}

/// Compiler flags of an image that is not the firmware. They replace the workspace's flags, which link the firmware's log; the
/// memory layout is the same.
pub fn link_flags() -> String {
    format!(
        "-C link-arg=--nmagic -C link-arg=-Tlink.x -L {}",
        workspace().display()
    )
}

fn build(toolchain: &Toolchain, folder: &'static str) -> Invocation {
    toolchain
        .cargo("build")
        .args([
            "--locked",
            "--release",
            "--manifest-path",
            "hil-sim/emulator/probe/Cargo.toml",
        ])
        .args(["--target", TARGET, "--target-dir", folder])
        .without(&["CARGO_ENCODED_RUSTFLAGS"])
        .env("RUSTFLAGS", link_flags())
}

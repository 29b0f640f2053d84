//! Images that are not the firmware: that of the emulator's own tests, and that of the benchmark.
use anyhow::Result;

use crate::process::workspace;
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

/// `cargo xtask probe`: builds the image for the tests of the emulated microcontroller and prints its path.
pub fn probe(permission: Permission) -> Result<()> {
    let package = [
        "--release",
        "--manifest-path",
        "hil-sim/emulator/probe/Cargo.toml",
    ];
    build(permission, "target/probe", &package, "release/probe")
}

/// `cargo xtask bench-image`: builds the image that the benchmark runs and prints its path. The profile is that of the flashed
/// image, so that the model is compiled as it is there.
pub fn benchmark(permission: Permission) -> Result<()> {
    let package = "--package model-bench --bin image --features image --profile firmware";
    let package: Vec<_> = package.split(' ').collect();
    build(permission, "target/bench-image", &package, "firmware/image")
}

/// Builds an image in a target folder and prints the path of its ELF file, `elf` below the folder of the target. The compiler
/// flags replace those of the workspace, which link the firmware's log; the memory layout is the same.
fn build(permission: Permission, folder: &str, package: &[&str], elf: &str) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    let folder = match &toolchain {
        Toolchain::Active => folder.to_owned(),
        Toolchain::Distribution(_) => format!("{folder}-distribution"),
    };
    let layout = workspace().display();
    toolchain
        .cargo("build")
        .args(["--locked", "--target", TARGET, "--target-dir", &folder])
        .args(package.iter().copied())
        .without(&["CARGO_ENCODED_RUSTFLAGS"])
        .env(
            "RUSTFLAGS",
            format!("-C link-arg=--nmagic -C link-arg=-Tlink.x -L {layout}"),
        )
        .run_to_stderr()?;
    let elf = workspace().join(folder).join(TARGET).join(elf);
    println!("{}", elf.display());
    Ok(())
}

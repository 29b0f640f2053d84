//! Images that are not the firmware: those of the emulator's own tests, and that of the benchmark.
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

/// Package of the images of `cargo xtask probe`, and their target folder.
const PROBE: &str = "hil-sim/emulator/probe/Cargo.toml";
const PROBE_FOLDER: &str = "target/probe";

/// `cargo xtask probe`: builds the image for the tests of the emulated microcontroller and prints its path.
pub fn probe(permission: Permission) -> Result<()> {
    let package = ["--release", "--manifest-path", PROBE];
    build(permission, PROBE_FOLDER, &package, "release/probe")
}

/// Lints the image of [`probe`].
pub fn clippy_of_probe(toolchain: &Toolchain) -> Invocation {
    toolchain
        .cargo("clippy")
        .args(["--release", "--locked", "--target", TARGET])
        .args(["--target-dir", &folder_of(toolchain, PROBE_FOLDER)])
        .args(["--manifest-path", PROBE, "--", "-Dwarnings"])
}

/// Package of the programs of `cargo xtask foreign`.
pub const FOREIGN: &str = "hil-sim/emulator/foreign/Cargo.toml";

/// The program of [`FOREIGN`] that the suite compiles: clocks, DMA and serial port by the published HAL, which needs few drivers.
const FOREIGN_OF_THE_SUITE: &str = "serial-dma";

/// `cargo xtask foreign`: builds the suite's program that others wrote, or all of them and ours on others' drivers, and prints
/// their folder.
pub fn foreign(permission: Permission, all: bool) -> Result<()> {
    fetch_foreign()?;
    copy_examples()?;
    let chosen: &[_] = if all {
        &["--workspace", "--all-features"]
    } else {
        &["--package", "hal-examples", "--bin", FOREIGN_OF_THE_SUITE]
    };
    let package = [&["--release", "--manifest-path", FOREIGN], chosen].concat();
    build(permission, "target/foreign", &package, "release")
}

/// Downloads the sources of all dependencies of [`FOREIGN`].
pub fn fetch_foreign() -> Result<()> {
    Invocation::cargo(["fetch", "--locked", "--manifest-path", FOREIGN]).run_to_stderr()
}

/// Copies the examples of the published crate stm32f4xx-hal to where [`FOREIGN`] names them; cargo builds no examples of a
/// dependency.
fn copy_examples() -> Result<()> {
    let query = ["metadata", "--format-version=1", "--offline", "--locked"];
    let metadata = Invocation::cargo(query).args(["--manifest-path", FOREIGN]);
    let metadata = metadata.answer().with_context(|| format!("`{metadata}` failed"))?;
    let manifest = metadata
        .split("\"manifest_path\":\"")
        .filter_map(|rest| rest.split('"').next())
        .find(|path| path.contains("stm32f4xx-hal-0"))
        .context("cargo metadata lists no stm32f4xx-hal")?;
    let from = Path::new(manifest).with_file_name("examples");
    let to = workspace().join("target/foreign-sources/stm32f4xx-hal/examples");
    fs::create_dir_all(&to).with_context(|| to.display().to_string())?;
    for file in fs::read_dir(&from).with_context(|| from.display().to_string())? {
        let file = file?.path();
        let (Some(name), Some("rs")) =
            (file.file_name(), file.extension().and_then(|e| e.to_str()))
        else {
            continue;
        };
        let source = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        // The examples are for boards with a crystal of 25 MHz, a NUCLEO's clock has 8 MHz.
        let source = source.replace("hse(25.MHz())", "hse(8.MHz())");
        let copy = to.join(name);
        // A new time of modification would be a reason for cargo to compile it again.
        if fs::read_to_string(&copy).ok().as_ref() != Some(&source) {
            fs::write(&copy, source).with_context(|| copy.display().to_string())?;
        }
    }
    Ok(())
}

/// `cargo xtask bench-image`: builds the image that the benchmark runs and prints its path. The profile is that of the flashed
/// image, so that the model is compiled as it is there, and so is the folder, which has the macros compiled.
pub fn benchmark(permission: Permission) -> Result<()> {
    let package = "--package model-bench --bin image --features image --profile firmware";
    let package: Vec<_> = package.split(' ').collect();
    build(permission, "target/firmware", &package, "firmware/image")
}

/// Target folder of a toolchain: compilers that shared one would rebuild each other's artifacts.
fn folder_of(toolchain: &Toolchain, folder: &str) -> String {
    match toolchain {
        Toolchain::Active => folder.to_owned(),
        Toolchain::Distribution(_) => format!("{folder}-distribution"),
    }
}

/// Builds an image in a target folder and prints a path, that of its ELF file or folder `elf` below the folder of the target. The compiler
/// flags replace those of the workspace, which link the firmware's log; the memory layout is the same.
fn build(permission: Permission, folder: &str, package: &[&str], elf: &str) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    let folder = folder_of(&toolchain, folder);
    let layout = workspace().display();
    toolchain
        .cargo("build")
        .args(["--locked", "--target", TARGET, "--target-dir", &folder])
        .args(package.iter().copied())
        .without(&["CARGO_ENCODED_RUSTFLAGS"])
        .env("RUSTFLAGS", format!("-C link-arg=--nmagic -C link-arg=-Tlink.x -L {layout}"))
        .run_to_stderr()?;
    let elf = workspace().join(folder).join(TARGET).join(elf);
    println!("{}", elf.display());
    Ok(())
}

//! The image as it is flashed.
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::image::{Memory, Usage};
use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

const PROFILE: &str = "firmware";
const PACKAGE: &str = "thermal-display";
const BOARD: &str = "nucleo-f446re";

/// What in a user's environment would change the image; the log level is that of `.cargo/config.toml`.
const FOREIGN_FLAGS: [&str; 5] = [
    "RUSTFLAGS",
    "CARGO_ENCODED_RUSTFLAGS",
    "CARGO_BUILD_RUSTFLAGS",
    "CARGO_BUILD_TARGET",
    "DEFMT_LOG",
];

/// The folder that cargo builds the image in. One for each compiler, neither that of host builds: compilers that
/// share a folder rebuild each other's work.
fn target_folder(toolchain: &Toolchain) -> &'static str {
    match toolchain {
        Toolchain::Active => "target/firmware",
        Toolchain::Distribution(_) => "target/firmware-distribution",
    }
}

/// The ELF file that [`build`] leaves.
pub fn elf(toolchain: &Toolchain) -> PathBuf {
    workspace()
        .join(target_folder(toolchain))
        .join(TARGET)
        .join(PROFILE)
        .join(PACKAGE)
}

/// `cargo SUBCOMMAND` for the image, in its own folder.
fn cargo(toolchain: &Toolchain, subcommand: &str) -> Invocation {
    let folder = target_folder(toolchain);
    toolchain
        .cargo(subcommand)
        .args([
            "--locked",
            "--package",
            PACKAGE,
            "--profile",
            PROFILE,
            "--target",
            TARGET,
            "--features",
            BOARD,
        ])
        .args(["--target-dir", folder])
        .without(&FOREIGN_FLAGS)
}

/// Builds the image.
pub fn build(toolchain: &Toolchain) -> Invocation {
    cargo(toolchain, "build")
}

/// Lints what only the microcontroller's target compiles.
pub fn clippy(toolchain: &Toolchain) -> Invocation {
    cargo(toolchain, "clippy").args(["--", "-Dwarnings"])
}

/// Path, flash and RAM use of the built image.
pub fn describe(toolchain: &Toolchain) -> Result<String> {
    let path = elf(toolchain);
    let read =
        |path: &PathBuf| std::fs::read(path).with_context(|| format!("cannot read {}", path.display()));
    let script = workspace().join("memory.x");
    let memory = Memory::parse(&String::from_utf8_lossy(&read(&script)?))
        .with_context(|| format!("in {}", script.display()))?;
    let usage = Usage::of_elf(&read(&path)?, &memory).with_context(|| format!("in {}", path.display()))?;
    Ok(format!("image  {}\n{}", path.display(), usage.against(&memory)))
}

/// `cargo xtask firmware`
pub fn run(permission: Permission, print_path: bool) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    build(&toolchain).run_to_stderr()?;
    let description = describe(&toolchain)?;
    if print_path {
        eprintln!("{description}");
        println!("{}", elf(&toolchain).display());
    } else {
        println!("{description}");
    }
    Ok(())
}

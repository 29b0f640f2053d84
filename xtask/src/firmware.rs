//! `cargo xtask firmware`: builds the image exactly as it is flashed.
use std::fs::{self, File};
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::memory_usage::{Memory, Usage};
use crate::process::{Invocation, workspace};
use crate::program_digest;
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

const PROFILE: &str = "firmware";
const PACKAGE: &str = "thermal-display";

/// Number of fingers of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Fingers {
    /// One, on the NUCLEO-F446RE
    #[default]
    #[value(name = "1")]
    One,
    /// Five, whose signals are multiplexed
    #[value(name = "5")]
    Five,
}

impl Fingers {
    /// The number as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::Five => "5",
        }
    }

    fn feature(self) -> &'static str {
        match self {
            Self::One => "nucleo-f446re",
            Self::Five => "five-fingers",
        }
    }
}

/// Variables of a user's environment that would change the image; the log level is that of `.cargo/config.toml`.
const FOREIGN_FLAGS: [&str; 5] = [
    "RUSTFLAGS",
    "CARGO_ENCODED_RUSTFLAGS",
    "CARGO_BUILD_RUSTFLAGS",
    "CARGO_BUILD_TARGET",
    "DEFMT_LOG",
];

/// Target folder of the images. Compilers that shared one would rebuild each other's artifacts.
fn target_folder(toolchain: &Toolchain) -> &'static str {
    match toolchain {
        Toolchain::Active => "target/firmware",
        Toolchain::Distribution(_) => "target/firmware-distribution",
    }
}

/// The ELF file that [`build`] writes.
pub fn elf(toolchain: &Toolchain, fingers: Fingers) -> PathBuf {
    let name = match fingers {
        Fingers::One => "thermal-display.elf",
        Fingers::Five => "thermal-display-five-fingers.elf",
    };
    workspace().join(target_folder(toolchain)).join(name)
}

/// `cargo SUBCOMMAND` for the image in its own target folder.
fn cargo(toolchain: &Toolchain, fingers: Fingers, subcommand: &str) -> Invocation {
    cargo_for(toolchain, PACKAGE, fingers, subcommand)
}

fn cargo_for(
    toolchain: &Toolchain,
    package: &str,
    fingers: Fingers,
    subcommand: &str,
) -> Invocation {
    let folder = target_folder(toolchain);
    toolchain
        .cargo(subcommand)
        .args(["--locked", "--package", package, "--profile", PROFILE])
        .args(["--features", fingers.feature()])
        .args(["--target", TARGET, "--target-dir", folder])
        .without(&FOREIGN_FLAGS)
}

/// Builds the image and copies it to [`elf`]. Images of one and of five fingers share a target folder, so that dependencies
/// are compiled once. Cargo writes both to the same path: a lock keeps other calls from building between build and copy.
pub fn build(toolchain: &Toolchain, fingers: Fingers) -> Result<()> {
    let folder = workspace().join(target_folder(toolchain));
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let lock = File::create(folder.join("image.lock"))?;
    lock.lock()?;
    cargo(toolchain, fingers, "build").run_to_stderr()?;
    let built = folder.join(TARGET).join(PROFILE).join(PACKAGE);
    let built = fs::read(&built).with_context(|| built.display().to_string())?;
    let elf = elf(toolchain, fingers);
    // Other programs may be reading the file: an unchanged one stays, a new one replaces it at once.
    if !fs::read(&elf).is_ok_and(|old| old == built) {
        let new = elf.with_extension("new");
        fs::write(&new, built).with_context(|| new.display().to_string())?;
        fs::rename(&new, &elf).with_context(|| elf.display().to_string())?;
    }
    Ok(())
}

/// `cargo SUBCOMMAND` for the tests that run on the microcontroller, compiled as the image is.
pub fn tests(toolchain: &Toolchain, subcommand: &str) -> Invocation {
    cargo_for(toolchain, "on-target-tests", Fingers::One, subcommand).args(["--tests"])
}

/// Lints the code that is compiled for the microcontroller only.
pub fn clippy(toolchain: &Toolchain, fingers: Fingers) -> Invocation {
    cargo(toolchain, fingers, "clippy").args(["--", "-Dwarnings"])
}

/// Lints [`tests`].
pub fn clippy_of_tests(toolchain: &Toolchain) -> Invocation {
    tests(toolchain, "clippy").args(["--", "-Dwarnings"])
}

/// Path, digest, flash and RAM use of the built image.
pub fn describe(toolchain: &Toolchain, fingers: Fingers) -> Result<String> {
    let path = elf(toolchain, fingers);
    let read =
        |path: &PathBuf| fs::read(path).with_context(|| format!("cannot read {}", path.display()));
    let script = workspace().join("memory.x");
    let memory = Memory::parse(&String::from_utf8_lossy(&read(&script)?))
        .with_context(|| format!("in {}", script.display()))?;
    let image = read(&path)?;
    let within = || format!("in {}", path.display());
    let usage = Usage::of_elf(&image, &memory).with_context(within)?;
    let digest = program_digest::of_elf(&image).with_context(within)?;
    let usage = usage.against(&memory);
    Ok(format!(
        "image  {}\n       program={digest:08x}, as `board` answers\n{usage}",
        path.display()
    ))
}

/// `cargo xtask firmware`
pub fn run(permission: Permission, fingers: Fingers, print_path: bool) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    build(&toolchain, fingers)?;
    let description = describe(&toolchain, fingers)?;
    if print_path {
        eprintln!("{description}");
        println!("{}", elf(&toolchain, fingers).display());
    } else {
        println!("{description}");
    }
    Ok(())
}

//! `cargo xtask bench`: run time against error of the contact model, of alternatives to it, and of the simulated plant.
use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;

use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};
use crate::{probe, report};

/// The profile of the flashed image, so that the model is compiled as it is there.
const PROFILE: &str = "firmware";

/// Subject of the measurement.
#[derive(Clone, Copy, ValueEnum)]
pub enum Job {
    /// The contact model and alternatives to it
    Model,
    /// The simulated plant on this host
    Plant,
}

/// `cargo xtask bench`; a relative `out` is relative to the caller's folder.
pub fn run(permission: Permission, job: Job, json: bool, out: Option<PathBuf>) -> Result<()> {
    let job = match job {
        Job::Model => "model",
        Job::Plant => "plant",
    };
    report::run(permission, ("model-bench", job), json, out, Vec::new())
}

/// `cargo xtask bench-image`: builds the image that the benchmark runs and prints its path.
pub fn build_image(permission: Permission) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    let folder = match &toolchain {
        Toolchain::Active => "target/bench-image",
        Toolchain::Distribution(_) => "target/bench-image-distribution",
    };
    image(&toolchain, folder).run_to_stderr()?;
    let folder = workspace().join(folder).join(TARGET);
    let elf = folder.join(PROFILE).join("image");
    println!("{}", elf.display());
    Ok(())
}

fn image(toolchain: &Toolchain, folder: &'static str) -> Invocation {
    toolchain
        .cargo("build")
        .args(["--locked", "--package", "model-bench", "--bin", "image"])
        .args(["--features", "image", "--profile", PROFILE])
        .args(["--target", TARGET, "--target-dir", folder])
        .without(&["CARGO_ENCODED_RUSTFLAGS"])
        .env("RUSTFLAGS", probe::link_flags())
}

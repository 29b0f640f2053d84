//! Run time against error of the contact model and its peers, and of the simulated plant.
use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;

use crate::probe;
use crate::process::{Invocation, workspace};
use crate::setup::{self, Needs, Permission, TARGET, Toolchain};

/// The profile of the flashed image, so that the model is compiled as it is there.
const PROFILE: &str = "firmware";

/// What is measured.
#[derive(Clone, Copy, ValueEnum)]
pub enum Job {
    /// The contact model and its peers
    Model,
    /// The simulated plant, on this host
    Plant,
}

/// `cargo xtask bench`; a relative `out` is one of the caller's folder.
pub fn run(permission: Permission, job: Job, json: bool, out: Option<PathBuf>) -> Result<()> {
    let out = out.map(|folder| {
        // Commands run in the workspace's root.
        std::path::absolute(&folder).with_context(|| format!("--out {}", folder.display()))
    });
    let out = out.transpose()?;
    let needs = Needs {
        emulator: true,
        lints: false,
    };
    setup::prepare(needs, permission)?;
    let mut line: Vec<OsString> = ["run", "--release", "--package", "model-bench", "--"]
        .map(OsString::from)
        .into();
    line.push(match job {
        Job::Model => "model".into(),
        Job::Plant => "plant".into(),
    });
    if json {
        line.push("--json".into());
    }
    if let Some(folder) = out {
        line.extend(["--out".into(), folder.into()]);
    }
    permission.choice.handed_to(Invocation::cargo(line)).run()
}

/// `cargo xtask bench-image`: builds the image that the benchmark runs and prints its path.
pub fn build_image(permission: Permission) -> Result<()> {
    let toolchain = setup::prepare(Needs::default(), permission)?;
    let folder = match &toolchain {
        Toolchain::Active => "target/bench-image",
        Toolchain::Distribution(_) => "target/bench-image-distribution",
    };
    image(&toolchain, folder).run_to_stderr()?;
    let elf = workspace().join(folder).join(TARGET).join(PROFILE).join("image");
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

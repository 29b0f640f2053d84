//! Builds the image of the current sources.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, bail};

/// Builds the image for 1 or 5 fingers from the current sources, exactly as it is flashed; its path.
///
/// # Errors
/// The build failed, or the cross compiler cannot be had; what to do is on standard error.
pub fn build(fingers: usize) -> anyhow::Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .context("hil-sim/emulator lies in no repository")?;
    let built = Command::new("cargo")
        .args(["xtask", "firmware", "--print-path", "--fingers"])
        .arg(fingers.to_string())
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .context(
            "cargo cannot be started to build the image; install Rust by rustup, or give an image by --elf",
        )?;
    if !built.status.success() {
        bail!("the image could not be built: `cargo xtask firmware` ended with {}", built.status);
    }
    let path = String::from_utf8(built.stdout).context("the path of the image is no text")?;
    Ok(PathBuf::from(path.trim()))
}

//! Files that hold a measurement, and are replaced only if someone asks for it.

use std::path::Path;

use anyhow::anyhow;
use clap::Args;

use super::Failure;

#[derive(Args)]
pub struct KeptFiles {
    /// Replace files that are there already
    #[arg(long)]
    force: bool,
}

impl KeptFiles {
    /// Refuses a file of `--out` that is there, before anything is measured.
    pub fn check(&self, path: &Path) -> Result<(), Failure> {
        // A link that leads nowhere is there, too.
        let is_there = path.symlink_metadata().is_ok();
        // What is no file, such as /dev/stdout, loses nothing.
        let is_kept = is_there && !path.metadata().is_ok_and(|data| !data.is_file());
        if !is_kept || self.force {
            return Ok(());
        }
        Err(Failure::input(anyhow!(
            "--out {}: there is a measurement already; another name is allowed, or --force, which replaces it",
            path.display()
        )))
    }
}

//! Files that hold a measurement, and are replaced only if someone asks for it.

use std::io::ErrorKind;
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
        match path.symlink_metadata() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(error) => {
                let context = format!("--out {}", path.display());
                return Err(Failure::input(anyhow::Error::new(error).context(context)));
            }
            // A link that leads nowhere is there, too.
            Ok(_) => {}
        }
        // What is no file, such as /dev/stdout, loses nothing.
        if self.force || path.metadata().is_ok_and(|data| !data.is_file()) {
            return Ok(());
        }
        Err(Failure::input(anyhow!(
            "--out {}: there is a measurement already; another name is allowed, or --force, which replaces it",
            path.display()
        )))
    }
}

//! Commands of other packages that measure and write a report.
use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::process::Invocation;
use crate::setup::{self, Needs, Permission};

/// Options of a report.
#[derive(clap::Args)]
pub struct Options {
    /// Print one JSON object instead of the tables
    #[arg(long)]
    json: bool,
    /// Folder for the page, its picture and data
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs a command of a package; a relative `--out` is relative to the caller's folder.
pub fn run(
    permission: Permission,
    mut report: Invocation,
    options: Options,
    rest: Vec<OsString>,
) -> Result<()> {
    setup::prepare(Needs::EMULATOR, permission)?;
    if options.json {
        report = report.args(["--json"]);
    }
    if let Some(folder) = options.out {
        // Commands run in the workspace's root.
        let absolute = std::path::absolute(&folder);
        let folder = absolute.with_context(|| format!("--out {}", folder.display()))?;
        report = report.args([OsString::from("--out"), folder.into()]);
    }
    permission.choice.handed_to(report.args(rest)).run()
}

//! `hil-sim thesis`: the thesis's numbers beside the computed ones.

use std::io::{Write, stdout};
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use hil_sim::thesis::figure::figures;
use hil_sim::thesis::{self, ClosedForm};

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// Print all rows as one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for thesis.html, with the figures drawn, and thesis.csv
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Recomputes, prints, writes.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let chapters = thesis::chapters();
    if let Some(folder) = &arguments.out {
        let created = std::fs::create_dir_all(folder);
        created
            .with_context(|| format!("--out {}", folder.display()))
            .map_err(Failure::input)?;
        let figures = figures(&ClosedForm).map_err(Failure::run)?;
        thesis::write(folder, &chapters, &figures).map_err(Failure::run)?;
    }
    let mut text = if arguments.json {
        serde_json::to_string(&thesis::json(&chapters)).map_err(Failure::run)? + "\n"
    } else {
        thesis::table(&chapters)
    };
    if let (Some(folder), false) = (&arguments.out, arguments.json) {
        text += &format!("report: {}\n", folder.join(thesis::HTML).display());
    }
    stdout()
        .write_all(text.as_bytes())
        .context("standard output")
        .map_err(Failure::run)
}

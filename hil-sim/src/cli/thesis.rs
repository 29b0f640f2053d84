//! `hil-sim thesis`: the thesis's numbers beside the computed ones.

use std::path::PathBuf;

use clap::Args;
use thermal_thesis::figure::{differences, figures};
use thermal_thesis::{ClosedForm, FiniteVolumes};

use super::{Failure, output};

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
    let chapters = thermal_thesis::chapters();
    output::create(arguments.out.as_deref())?;
    let closed = figures(&ClosedForm).map_err(Failure::run)?;
    let apart = differences(&closed, &figures(&FiniteVolumes).map_err(Failure::run)?);
    if let Some(folder) = &arguments.out {
        thermal_thesis::write(folder, &chapters, &closed, &apart).map_err(Failure::run)?;
    }
    let mut text = if arguments.json {
        serde_json::to_string(&thermal_thesis::json(&chapters, &apart)).map_err(Failure::run)?
            + "\n"
    } else {
        thermal_thesis::table(&chapters, &apart)
    };
    if let (Some(folder), false) = (&arguments.out, arguments.json) {
        text += &format!("report: {}\n", folder.join(thermal_thesis::HTML).display());
    }
    output::print(&text)
}

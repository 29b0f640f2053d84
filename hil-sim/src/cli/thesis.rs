//! `hil-sim thesis`: the numbers of the thesis compared with computed ones.

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
    let measured = thermal_thesis::measurements().map_err(Failure::run)?;
    if let Some(folder) = &arguments.out {
        thermal_thesis::write(folder, &chapters, &closed, &apart, &measured)
            .map_err(Failure::run)?;
    }
    let page = arguments.out.as_ref();
    output::print_report(
        arguments.json,
        &thermal_thesis::json(&chapters, &apart, &measured),
        || thermal_thesis::table(&chapters, &apart, &measured),
        page.map(|folder| folder.join(thermal_thesis::HTML)),
    )
}

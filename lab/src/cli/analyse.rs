//! `thermal-lab analyse`: scores and statistics of a data set, as a page, JSON and CSV.

use std::fs;
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use session_analysis::analyse;
use thermal_session::dataset::recorded_sessions;

use super::{Failure, print_text};

#[derive(Args)]
pub struct Arguments {
    /// Folder of the data set, as `run` has written it
    folder: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for page, JSON and CSV
    #[arg(long, value_name = "DIR", default_value = "target/analysis")]
    out: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let sessions = recorded_sessions(&arguments.folder).map_err(Failure::input)?;
    let analysis = analyse(&sessions);
    let json = analysis.json() + "\n";
    let mut files = vec![
        ("analysis.html".to_owned(), analysis.page()),
        ("analysis.json".to_owned(), json.clone()),
    ];
    files.extend(analysis.csv());
    fs::create_dir_all(&arguments.out)
        .with_context(|| arguments.out.display().to_string())
        .map_err(Failure::run)?;
    for (name, text) in files {
        let path = arguments.out.join(name);
        fs::write(&path, text).with_context(|| path.display().to_string()).map_err(Failure::run)?;
        eprintln!("thermal-lab: wrote {}", path.display());
    }
    if arguments.json {
        print_text(&json)?;
    }
    Ok(())
}

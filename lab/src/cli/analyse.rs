//! `thermal-lab analyse`: scores and statistics of a data set, as a page, JSON and CSV.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, anyhow};
use clap::Args;
use session_analysis::{Simulated, analyse};
use thermal_session::dataset::recorded_sessions;

use super::{Failure, print_text};

#[derive(Args)]
pub struct Arguments {
    /// Folder of the data set, as `run` has written it
    folder: PathBuf,
    /// Analyse simulated participants together with real ones
    #[arg(long)]
    pool_simulated: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for page, JSON and CSV
    #[arg(long, value_name = "DIR", default_value = "target/analysis")]
    out: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let data = recorded_sessions(&arguments.folder).map_err(Failure::input)?;
    let simulated = if arguments.pool_simulated { Simulated::Pooled } else { Simulated::Apart };
    let analysis = analyse(&data, simulated);
    if analysis.tasks.is_empty() && !analysis.left_out.is_empty() {
        return Err(Failure::input(anyhow!("{}", analysis.left_out.join("\n"))));
    }
    for left_out in &analysis.left_out {
        eprintln!("thermal-lab: left out: {left_out}");
    }
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

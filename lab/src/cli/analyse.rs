//! `thermal-lab analyse`: scores and statistics of a data set, as a page, JSON and CSV.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use session_analysis::{Simulated, analyse, csv_names};
use thermal_client::text;
use thermal_session::dataset::recorded_sessions;

use super::{Failure, notice, print_text};

/// Name of the analysis, which also lists the tables that were written beside it.
const JSON: &str = "analysis.json";

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
        notice(&format!("left out: {left_out}"));
    }
    let json = analysis.json() + "\n";
    let mut files =
        vec![("analysis.html".to_owned(), analysis.page()), (JSON.to_owned(), json.clone())];
    files.extend(analysis.csv());
    fs::create_dir_all(&arguments.out)
        .with_context(|| arguments.out.display().to_string())
        .map_err(Failure::run)?;
    remove_earlier_tables(&arguments.out, &files).map_err(Failure::run)?;
    for (name, text) in files {
        let path = arguments.out.join(name);
        fs::write(&path, text).with_context(|| path.display().to_string()).map_err(Failure::run)?;
        notice(&format!("wrote {}", path.display()));
    }
    if arguments.json {
        print_text(&json)?;
    }
    Ok(())
}

/// Removes the tables of an earlier analysis in a folder that are not among the files of this one: beside them they would look
/// like its results. Its JSON lists them; nothing else is removed.
fn remove_earlier_tables(folder: &Path, files: &[(String, String)]) -> anyhow::Result<()> {
    let path = folder.join(JSON);
    let json = text::read_if_there(&path, text::TABLE_BYTES_MAX);
    let Some(json) = json.with_context(|| path.display().to_string())? else {
        return Ok(());
    };
    let Ok(earlier) = csv_names(&json) else {
        notice(&format!(
            "{}: this is not an analysis; tables of an earlier one, if there are any, stay in its folder",
            path.display()
        ));
        return Ok(());
    };
    for name in earlier {
        if files.iter().any(|(written, _)| *written == name) {
            continue;
        }
        let path = folder.join(name);
        match fs::remove_file(&path) {
            Ok(()) => notice(&format!("removed {}, of an earlier analysis", path.display())),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error).with_context(|| path.display().to_string()),
        }
    }
    Ok(())
}

//! `thermal-lab predict`: what experiments are to be expected to give, beside what was published.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::{Deserialize, Serialize};
use thermal_client::text;
use thermal_participant::predictions::{RenderedTouch, report, told_apart};

use super::{Failure, print_text};

#[derive(Args)]
pub struct Arguments {
    /// Print only the per cent correct in discriminating the touches of this file from touches of the objects themselves:
    /// populations.csv of `hil-sim fidelity --out`
    #[arg(long, value_name = "CSV")]
    touches: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.touches {
        None => print(arguments.json, &report().map_err(Failure::run)?),
        Some(file) => {
            let touches = read(file).map_err(Failure::input)?;
            let report = told_apart(&touches).map_err(Failure::input)?;
            print(arguments.json, &report)
        }
    }
}

fn print<T: Serialize + Display>(json: bool, report: &T) -> Result<(), Failure> {
    if json {
        let text = serde_json::to_string_pretty(report).map_err(Failure::run)?;
        return print_text(&(text + "\n"));
    }
    print_text(&report.to_string())
}

/// A line of the file; it has other columns, too.
#[derive(Deserialize)]
struct Line {
    population: String,
    case: String,
    told: String,
    skin_max_after_50ms_mk: f64,
    skin_max_after_500ms_mk: f64,
}

/// The touches whose object and finger were described to the device.
fn read(file: &Path) -> anyhow::Result<Vec<RenderedTouch>> {
    let context = |problem: csv::Error| anyhow::anyhow!("{}: {problem}", file.display());
    let mut touches = Vec::new();
    let text =
        text::open(file, text::TABLE_BYTES_MAX).map_err(|problem| context(problem.into()))?;
    let mut lines = csv::Reader::from_reader(text);
    if let Some(name) = text::repeated_column(lines.headers().map_err(context)?) {
        anyhow::bail!("{}:1: two columns {name:?}; allowed is each name once", file.display());
    }
    for (number, line) in (2..).zip(lines.deserialize()) {
        let line: Line = line.map_err(context)?;
        for (column, error_mk) in [
            ("skin_max_after_50ms_mk", line.skin_max_after_50ms_mk),
            ("skin_max_after_500ms_mk", line.skin_max_after_500ms_mk),
        ] {
            anyhow::ensure!(
                error_mk.is_finite(),
                "{}:{number}: {column} = {error_mk}; allowed is a finite number",
                file.display()
            );
        }
        if line.told == "as-it-is" {
            touches.push(RenderedTouch {
                group: line.population,
                object: line.case,
                max_after_50ms_mk: line.skin_max_after_50ms_mk,
                max_after_500ms_mk: line.skin_max_after_500ms_mk,
            });
        }
    }
    if touches.is_empty() {
        anyhow::bail!("{}: no line is told \"as-it-is\"", file.display());
    }
    Ok(touches)
}

//! `thermal-lab predict`: what experiments are to be expected to give, beside what was published.

use clap::Args;
use thermal_participant::predictions::report;

use super::{Failure, print_text};

#[derive(Args)]
pub struct Arguments {
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let report = report().map_err(Failure::run)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&report).map_err(Failure::run)?;
        return print_text(&(text + "\n"));
    }
    print_text(&report.to_string())
}

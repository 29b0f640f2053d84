//! Results on standard output, progress on standard error.

use std::cell::Cell;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
pub use thermal_charts::write;

use super::Failure;

/// Writes text, including its line ends, to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    stdout().write_all(text.as_bytes()).context("standard output").map_err(Failure::run)
}

/// Prints a report: with `--json` as one object, otherwise as a table, with the path of its page if one was written.
pub fn print_report(
    json: bool,
    report: &impl Serialize,
    table: impl FnOnce() -> String,
    page: Option<PathBuf>,
) -> Result<(), Failure> {
    if json {
        return print(&(serde_json::to_string(report).map_err(Failure::run)? + "\n"));
    }
    let page = page.map_or(String::new(), |page| format!("report: {}\n", page.display()));
    print(&(table() + &page))
}

/// The number of threads of a campaign: one per core unless the user chose another.
pub fn threads(chosen: Option<u16>) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    chosen.map_or_else(cores, usize::from)
}

/// A progress bar that counts the runs of a campaign.
pub fn run_counter(message: String, runs: usize) -> anyhow::Result<ProgressBar> {
    let style =
        ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}  {elapsed} of {duration}")?;
    Ok(ProgressBar::new(runs as u64).with_style(style).with_message(message))
}

/// Creates the folder of `--out` before a long run begins.
pub fn create(folder: Option<&Path>) -> Result<(), Failure> {
    let Some(folder) = folder else { return Ok(()) };
    std::fs::create_dir_all(folder)
        .with_context(|| format!("--out {}", folder.display()))
        .map_err(Failure::input)
}

/// Shows a progress bar while `work` runs; `work` reports the fraction done through its argument.
pub fn with_progress<R>(name: String, work: impl FnOnce(&dyn Fn(f64)) -> R) -> Result<R, Failure> {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed}");
    let bar = ProgressBar::new(1000).with_style(style.map_err(Failure::run)?);
    bar.set_message(name);
    let shown = Cell::new(0);
    let result = work(&|part| {
        // Work may report each simulated millisecond, and a bar takes longer than many of them.
        let position = (part * 1000.0) as u64;
        if shown.replace(position) != position {
            bar.set_position(position);
        }
    });
    bar.finish_and_clear();
    Ok(result)
}

//! Where results and progress go.

use std::io::{Write, stdout};
use std::path::Path;

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
pub use thermal_charts::write;

use super::Failure;

/// Writes a text with its line ends to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    stdout()
        .write_all(text.as_bytes())
        .context("standard output")
        .map_err(Failure::run)
}

/// Makes the folder of `--out`, before what may take long.
pub fn create(folder: Option<&Path>) -> Result<(), Failure> {
    let Some(folder) = folder else { return Ok(()) };
    std::fs::create_dir_all(folder)
        .with_context(|| format!("--out {}", folder.display()))
        .map_err(Failure::input)
}

/// Shows which part of `name` is done while `work` runs, which is handed where to tell it.
pub fn with_progress<R>(name: String, work: impl FnOnce(&dyn Fn(f64)) -> R) -> Result<R, Failure> {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed}");
    let bar = ProgressBar::new(1000).with_style(style.map_err(Failure::run)?);
    bar.set_message(name);
    let result = work(&|part| bar.set_position((part * 1000.0) as u64));
    bar.finish_and_clear();
    Ok(result)
}

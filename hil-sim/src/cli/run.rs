//! `hil-sim run`: a scene on an engine.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use clap::Args;
use thermal_sim::metrics::Figures;
use thermal_sim::processor::{Injection, ParseMachineFaultError};
use thermal_sim::report;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// A fault of the processor at a time of the scene, such as 2.5:hung-core or 1:core-bit=r4.7; may be repeated
    #[arg(long, value_name = "T_S:FAULT", value_parser = injection)]
    inject: Vec<Injection>,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Folder for report.html, plots.svg and trace.csv
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the scene for a program that began at a time; prints its figures and writes its report.
pub fn run(arguments: &Arguments, began: Instant) -> Result<(), Failure> {
    let (scene, world) = engine::scene(&arguments.scene)?;
    output::create(arguments.out.as_deref())?;
    let device = (arguments.engine, arguments.elf.as_deref());
    let (outcome, figures) = engine::run_scene(device, &scene, world, &arguments.inject, began)?;
    if let Some(folder) = &arguments.out {
        write(folder, &scene, &outcome, &figures).map_err(Failure::run)?;
    }
    let page = arguments.out.as_ref();
    output::print_report(
        arguments.json,
        &figures,
        || report::table(&figures),
        page.map(|folder| folder.join(report::HTML)),
    )
}

/// Time and fault of `T_S:FAULT`.
fn injection(text: &str) -> Result<Injection, String> {
    let (time, fault) = text
        .split_once(':')
        .ok_or("a time in seconds, a colon and a fault, such as 2.5:hung-core, is allowed")?;
    let t_s = (time.parse().ok().filter(|t_s: &f64| t_s.is_finite()))
        .ok_or_else(|| format!("`{time}` is no time in seconds"))?;
    let fault = fault.parse().map_err(|error: ParseMachineFaultError| error.to_string())?;
    Ok(Injection { t_s, fault })
}

fn write(folder: &Path, scene: &Scene, outcome: &Outcome, figures: &Figures) -> anyhow::Result<()> {
    let trace = folder.join("trace.csv");
    outcome.trace.write(&trace).with_context(|| trace.display().to_string())?;
    report::write(folder, scene, outcome, figures)
}

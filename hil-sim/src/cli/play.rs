//! `hil-sim play`: a course from a CSV file under a finger.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_client::course::{Prepared, Selection, read_course};
use thermal_sim::World;
use thermal_sim::play::{PlayFigures, scene};

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// CSV of two columns, t_s and celsius, from the landing on; or a trace.csv, which is played from landing to lift
    course: PathBuf,
    /// Column of a trace that is played [default: celsius, or display_c]
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// Force of the finger, N
    #[arg(long, value_name = "F", default_value_t = 2.0)]
    force_n: f64,
    /// Skin before the contact, °C
    #[arg(long, value_name = "T", default_value_t = 34.0)]
    skin_c: f64,
    /// Play it even if the device's points are more than 5 mK off
    #[arg(long)]
    coarse: bool,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Folder for trace.csv and points.csv
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the figures as one JSON object
    #[arg(long)]
    json: bool,
}

/// Plays the course for a program that began at a time; prints its figures.
pub fn run(arguments: &Arguments, began: Instant) -> Result<(), Failure> {
    let selection = Selection { column: arguments.column.as_deref() };
    let file = read_course(&arguments.course, selection).map_err(Failure::input)?;
    let played = Prepared::new(file, arguments.coarse, 1).map_err(Failure::input)?;
    eprintln!(
        "hil-sim: {} points, reduction error {:.2} mK",
        played.points.points().len(),
        played.error_k * 1e3
    );
    for (name, value, least, most) in
        [("--force-n", arguments.force_n, 0.01, 10.0), ("--skin-c", arguments.skin_c, 15.0, 42.0)]
    {
        if !(least..=most).contains(&value) {
            let problem = anyhow!("{name} {value}; {least} to {most} is allowed");
            return Err(Failure::input(problem));
        }
    }
    let scene = scene(&played, arguments.force_n, arguments.skin_c)
        .with_context(|| arguments.course.display().to_string())
        .map_err(Failure::input)?;
    output::create(arguments.out.as_deref())?;
    let world = World::new(&scene).context("plant").map_err(Failure::input)?;
    let device = (arguments.engine, arguments.elf.as_deref());
    let (outcome, figures) = engine::run_scene(device, &scene, world, &[], began)?;
    let figures = PlayFigures::new(&played, &scene, &outcome, figures);
    if let Some(folder) = &arguments.out {
        (outcome.trace.write(&folder.join("trace.csv")))
            .context("trace.csv")
            .map_err(Failure::run)?;
        output::write(folder, "points.csv", played.points.csv()).map_err(Failure::run)?;
    }
    output::print_report(arguments.json, &figures, || figures.table(), None)
}

//! `hil-sim run`: a scene on an engine.

use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use hil_sim::engine::{Engine, Image, Native};
use hil_sim::machine::Firmware;
use hil_sim::metrics::{Figures, figures};
use hil_sim::run::{Outcome, run as run_scene};
use hil_sim::scene::Scene;
use hil_sim::{World, firmware, report};
use indicatif::{ProgressBar, ProgressStyle};

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = Kind::Image)]
    engine: Kind,
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

/// What runs the device's logic.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// The release image in the emulated microcontroller
    Image,
    /// The same logic, called directly: faster, without cost figures
    Native,
}

/// Runs the scene; prints its figures and writes its report.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::read(&arguments.scene).map_err(Failure::input)?;
    let world = World::new(&scene)
        .with_context(|| arguments.scene.display().to_string())
        .map_err(Failure::input)?;
    if let Some(folder) = &arguments.out {
        // Before the run, which may be long.
        let created = std::fs::create_dir_all(folder);
        created
            .with_context(|| format!("--out {}", folder.display()))
            .map_err(Failure::input)?;
    }
    let (outcome, figures) = match arguments.engine {
        Kind::Native if arguments.elf.is_some() => {
            return Err(Failure::input(anyhow!(
                "--elf is for --engine image; the native engine runs no image"
            )));
        }
        Kind::Native => measure(&scene, &mut Native::new(world)),
        Kind::Image => {
            let path = match &arguments.elf {
                Some(path) => path.clone(),
                None => firmware::build(1).map_err(Failure::run)?,
            };
            let firmware = Firmware::from_file(&path)
                .with_context(|| path.display().to_string())
                .map_err(Failure::input)?;
            measure(&scene, &mut Image::new(&firmware, world).map_err(Failure::run)?)
        }
    }?;
    if let Some(folder) = &arguments.out {
        write(folder, &scene, &outcome, &figures).map_err(Failure::run)?;
    }
    let mut text = if arguments.json {
        serde_json::to_string(&figures).map_err(Failure::run)? + "\n"
    } else {
        report::table(&figures)
    };
    if let (Some(folder), false) = (&arguments.out, arguments.json) {
        text += &format!("report: {}\n", folder.join(report::HTML).display());
    }
    stdout()
        .write_all(text.as_bytes())
        .context("standard output")
        .map_err(Failure::run)
}

fn measure<E: Engine>(scene: &Scene, engine: &mut E) -> Result<(Outcome, Figures), Failure> {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed}");
    let bar = ProgressBar::new(1000).with_style(style.map_err(Failure::run)?);
    bar.set_message(format!("{} on engine {}", scene.object.name, E::NAME));
    let outcome = run_scene(scene, engine, |part| bar.set_position((part * 1000.0) as u64));
    bar.finish_and_clear();
    let outcome = outcome.map_err(Failure::run)?;
    let figures = figures::<E>(scene, &outcome);
    Ok((outcome, figures))
}

fn write(folder: &Path, scene: &Scene, outcome: &Outcome, figures: &Figures) -> anyhow::Result<()> {
    let trace = folder.join("trace.csv");
    outcome
        .trace
        .write(&trace)
        .with_context(|| trace.display().to_string())?;
    report::write(folder, scene, outcome, figures)
}

//! `hil-sim display`: what earlier displays would have shown.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use contact_model::material::THESIS_MATERIALS;
use earlier_displays::{
    Comparison, Display, Report, Showing, SingleContact, Tissue, chart, page, scene, table,
};
use serde::Serialize;
use thermal_campaigns::parallel_map;
use thermal_client::course::Course;
use thermal_sim::SceneRunner;
use thermal_sim::scene::Scene;

use super::engine::{self, EngineKind};
use super::{Failure, output};

/// Files of `--out`.
const HTML: &str = "displays.html";
const SVG: &str = "displays.svg";

#[derive(Args)]
pub struct Arguments {
    /// The scene, TOML, with one contact; without it and with --all: 2 N for 10 s, nine materials, two fingers
    scene: Option<PathBuf>,
    /// The display
    #[arg(long, value_name = "NAME", value_parser = displays(), required_unless_present = "all")]
    display: Option<Display>,
    /// All displays, side by side
    #[arg(long, conflicts_with = "display")]
    all: bool,
    /// On an ideal tile alone, without the device
    #[arg(long, requires = "all", conflicts_with_all = ["engine", "elf"])]
    ideal_only: bool,
    /// What runs the device's logic [default: native with --all, or that of `run`]
    #[arg(long, value_enum)]
    engine: Option<EngineKind>,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Number of runs at a time [default: one a core]
    #[arg(long)]
    threads: Option<u16>,
    /// Folder for course.csv and trace.csv, or, with --all, displays.html and displays.svg
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn displays() -> impl TypedValueParser<Value = Display> {
    let names = Display::ALL.map(Display::name);
    PossibleValuesParser::new(names).map(|name| {
        let mut all = Display::ALL.into_iter();
        all.find(|display| display.name() == name).unwrap_or(Display::Ours)
    })
}

/// Runs one display or all.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::create(arguments.out.as_deref())?;
    match arguments.display {
        Some(display) => one(arguments, display),
        None => all(arguments),
    }
}

/// One display in a scene, with its course.
#[derive(Serialize)]
struct One {
    source: &'static str,
    assumed: &'static str,
    /// Seconds since the landing and °C of the points that the device was given.
    course: Option<Vec<[f64; 2]>>,
    #[serde(flatten)]
    comparison: Comparison,
}

fn one(arguments: &Arguments, display: Display) -> Result<(), Failure> {
    let Some(path) = &arguments.scene else {
        return Err(Failure::input(anyhow!(
            "a display is computed for a scene, such as scenes/granite.toml; without one --all is allowed"
        )));
    };
    let scene = engine::read(path)?;
    let touch = touch(&scene, path)?;
    let runner = runner(arguments, EngineKind::DEFAULT)?;
    let (comparison, outcome) =
        Comparison::run(runner.as_ref(), &scene, display).map_err(Failure::run)?;
    let showing = display.showing(&scene, &touch).map_err(Failure::run)?;
    if let Some(folder) = &arguments.out {
        if let Showing::Course { course, .. } = &showing {
            output::write(folder, "course.csv", course.csv()).map_err(Failure::run)?;
        }
        let trace = folder.join("trace.csv");
        outcome.trace.write(&trace).map_err(Failure::run)?;
    }
    let report = Report::new(vec![comparison.clone()]);
    let one = One {
        source: display.source(),
        assumed: display.assumed(),
        course: match showing {
            Showing::Course { course, .. } => Some(rows(&course)),
            Showing::Mode { .. } => None,
        },
        comparison,
    };
    let text = || {
        format!(
            "{}\nsource: {}\nassumed: {}\n{}",
            display.name(),
            one.source,
            one.assumed,
            table(&report)
        )
    };
    output::print_report(arguments.json, &one, text, None)
}

fn rows(course: &Course) -> Vec<[f64; 2]> {
    let points = course.points().iter();
    points.map(|point| [point.t_s, point.celsius]).collect()
}

fn all(arguments: &Arguments) -> Result<(), Failure> {
    let scenes = match &arguments.scene {
        Some(path) => {
            let scene = engine::read(path)?;
            touch(&scene, path)?;
            vec![scene]
        }
        None => Tissue::ALL
            .iter()
            .flat_map(|tissue| THESIS_MATERIALS.iter().map(|material| scene(material, *tissue)))
            .collect(),
    };
    let runner = match arguments.ideal_only {
        true => None,
        false => Some(runner(arguments, EngineKind::Native)?),
    };
    let jobs: Vec<_> =
        scenes.iter().flat_map(|scene| Display::ALL.map(|display| (scene, display))).collect();
    let bar = output::run_counter("displays".into(), jobs.len()).map_err(Failure::run)?;
    let rows = parallel_map(
        &jobs,
        output::threads(arguments.threads),
        |(scene, display)| match &runner {
            Some(runner) => Ok(Comparison::run(runner.as_ref(), scene, *display)?.0),
            None => Comparison::on_ideal_tile(scene, *display),
        },
        || bar.inc(1),
    );
    bar.finish_and_clear();
    let report = Report::new(rows.map_err(Failure::run)?);
    if let Some(folder) = &arguments.out {
        write(folder, &report).map_err(Failure::run)?;
    }
    let page = arguments.out.as_ref().map(|folder| folder.join(HTML));
    output::print_report(arguments.json, &report, || table(&report), page)
}

fn write(folder: &Path, report: &Report) -> anyhow::Result<()> {
    let svg = chart(report)?.unwrap_or_default();
    output::write(folder, HTML, page(report, &svg))?;
    output::write(folder, SVG, svg)
}

fn touch(scene: &Scene, path: &Path) -> Result<SingleContact, Failure> {
    SingleContact::of(scene).map_err(|error| Failure::input(anyhow!("{}: {error}", path.display())))
}

fn runner(arguments: &Arguments, without: EngineKind) -> Result<Box<dyn SceneRunner>, Failure> {
    engine::runner(arguments.engine.unwrap_or(without), arguments.elf.as_deref())
}

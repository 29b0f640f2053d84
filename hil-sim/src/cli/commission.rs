//! `hil-sim commission`: commissioning by the simulated operator, and restoring settings.

use std::io::{Write, stderr};
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};
use clap::Args;
use serde_json::json;
use thermal_campaigns::{parallel_map, survey_device, survey_table};
use thermal_client::text;
use thermal_plant::{Params, parameters};
use thermal_sim::commissioning::{
    CommissioningEvent, CommissioningRecord, CommissioningSetup, commission, restore,
};
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::scene::Scene;

use super::engine::{self, EngineKind};
use super::{Failure, output};

/// Text after the options in the help.
const USAGE: &str = "\
The operator holds a reference thermometer to each sensor, types what it shows, and lets the device find out what its
tile is like. It then has the device save that, which outlives switching off. Progress goes to standard error.
Standard output has the same as lines, for another device with these sensors, or for this one after `forget`.

  hil-sim commission scenes/copper.toml > settings.txt
  hil-sim commission scenes/copper.toml --restore settings.txt
  hil-sim commission --box 200";

#[derive(Args)]
#[command(after_help = USAGE)]
pub struct Arguments {
    /// A scene whose device is commissioned
    #[arg(conflicts_with_all = ["draw", "survey"], required_unless_present_any = ["draw", "survey"])]
    scene: Option<PathBuf>,
    /// Instead, a device of the parameter box, drawn by this seed
    #[arg(long, value_name = "SEED")]
    draw: Option<u64>,
    /// Instead, that many devices of the box, from seed 1 on, native: how well they identify themselves, as percentiles
    #[arg(long = "box", value_name = "N", conflicts_with_all = ["draw", "restore", "engine", "elf"])]
    survey: Option<u64>,
    /// Sends the lines of a file to a device that was just switched on, instead of commissioning it
    #[arg(long, value_name = "FILE")]
    restore: Option<PathBuf>,
    /// Room of a drawn device, C
    #[arg(long, default_value_t = 24.0, conflicts_with_all = ["scene", "survey"])]
    room_c: f64,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::Native)]
    engine: EngineKind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Print one JSON object: points, tile with margins, settings
    #[arg(long)]
    json: bool,
}

/// Commissions or restores, and prints.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(devices) = arguments.survey {
        return survey_devices(devices, arguments.json);
    }
    let plants = match (&arguments.scene, arguments.draw) {
        (Some(path), _) => {
            let scene = Scene::read(path).map_err(Failure::input)?;
            CommissioningSetup::new(&scene.params, scene.room_c, scene.seed)
        }
        (None, draw) => {
            let (mut params, seed) = (Params::nominal(), draw.unwrap_or_default());
            parameters::draw(&mut params, seed);
            CommissioningSetup::new(&params, arguments.room_c, seed)
        }
    };
    let world = plants.in_use().map_err(Failure::input)?;
    let elf = arguments.elf.as_deref();
    match arguments.engine {
        EngineKind::Native => {
            engine::refuse_elf(elf)?;
            commission_on(arguments, &plants, &mut NativeEngine::new(world))
        }
        #[cfg(feature = "emulator")]
        EngineKind::Image => {
            commission_on(arguments, &plants, &mut super::image::engine(elf, world)?)
        }
    }
}

fn commission_on<E: Engine>(
    arguments: &Arguments,
    plants: &CommissioningSetup,
    engine: &mut E,
) -> Result<(), Failure> {
    if let Some(path) = &arguments.restore {
        let settings = lines(path).map_err(Failure::input)?;
        let tile = restore(engine, &settings).map_err(Failure::run)?;
        let text = if arguments.json {
            serde_json::to_string(&tile).map_err(Failure::run)?
        } else {
            format!("{} lines taken; {tile}", settings.len())
        };
        return print(&text);
    }
    let done = commission(plants, engine, &mut print_event).map_err(Failure::run)?;
    let CommissioningRecord { settings, .. } = &done;
    if arguments.json {
        print(&serde_json::to_string(&done).map_err(Failure::run)?)
    } else {
        print(&settings.join("\n"))
    }
}

/// The lines of a file, without empty ones.
fn lines(path: &Path) -> anyhow::Result<Vec<String>> {
    let text = text::read(path, text::DOCUMENT_BYTES_MAX)
        .with_context(|| format!("--restore {}", path.display()))?;
    let lines: Vec<String> =
        (text.lines().map(|line| line.trim().to_owned())).filter(|line| !line.is_empty()).collect();
    for (number, line) in (1..).zip(&lines) {
        ensure!(
            line.starts_with("set "),
            "--restore {}: line {number} is '{line}'; lines of settings begin with 'set'",
            path.display()
        );
    }
    ensure!(!lines.is_empty(), "--restore {} has no lines", path.display());
    Ok(lines)
}

/// Prints an event on standard error, which may be closed.
fn print_event(event: &CommissioningEvent) {
    let _ignored = writeln!(stderr(), "{event}");
}

fn survey_devices(devices: u64, json: bool) -> Result<(), Failure> {
    let draws: Vec<u64> = (1..=devices).collect();
    let threads = output::threads(None);
    let work = |draw: &u64| Ok((*draw, survey_device(*draw)));
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for (draw, one) in parallel_map(&draws, threads, work, || ()).map_err(Failure::run)? {
        match one {
            Ok(one) => found.push(one),
            Err(why) => failed.push(json!({ "draw": draw, "why": why.to_string() })),
        }
    }
    if json {
        let all = json!({ "devices": found, "failed": failed });
        return print(&serde_json::to_string(&all).map_err(Failure::run)?);
    }
    print(survey_table(&found).trim_end())?;
    for failed in &failed {
        print(&format!("not among them: {failed}"))?;
    }
    Ok(())
}

fn print(text: &str) -> Result<(), Failure> {
    output::print(&format!("{text}\n"))
}

//! `hil-sim faults`: the fault-injection matrix, and what is built on it.

mod campaign;
mod flips;
mod normal;
mod pairs;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::anyhow;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use thermal_campaigns::faults::{self, Entry, Outline, Place, Plan, Trial};
use thermal_campaigns::map;
use thermal_sim::Device;

use super::device::{self, Kind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// Faults of these kinds only, such as thermistor-open
    #[arg(long, num_args = 1.., value_name = "KIND")]
    only: Vec<String>,
    /// In these scenes only
    #[arg(long, num_args = 1.., value_parser = places())]
    scene: Vec<Place>,
    /// Moments of each fault, spread over the scenes
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..))]
    moments: u16,
    /// Of moments, of the order of scenes, and of the device's converter
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = Kind::USUAL)]
    engine: Kind,
    /// Image to run instead of the one of the current sources
    #[arg(long)]
    elf: Option<PathBuf>,
    /// Threads [default: one a core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Folder for faults.html, or for scenes of the other modes
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    modes: Modes,
    /// Again the campaign of a number, or with --flips the flip; its scene goes to --out
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(..10_000_000),
        conflicts_with_all = ["only", "scene", "moments", "campaign", "pairs", "normal"])]
    replay: Option<u64>,
}

/// What is run instead of the matrix; one of them.
#[derive(Args)]
#[group(multiple = false, conflicts_with_all = ["only", "scene", "moments"])]
struct Modes {
    /// Instead of the matrix: N random campaigns (fault, moment, scene, plant) of the seed
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    campaign: Option<u64>,
    /// Instead of the matrix: N single bit flips of the running image (place, bit, moment, scene) of the seed; scenes of
    /// those that break a limit go to --out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    flips: Option<u64>,
    /// Every fault that may go unnoticed before every other one; scenes of those that break the claim go to --out
    #[arg(long)]
    pairs: bool,
    /// Simulated hours of normal use over the parameter box, in which nothing may trip; scenes that do go to --out
    #[arg(long, value_name = "HOURS", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    normal: Option<u64>,
}

fn places() -> impl TypedValueParser<Value = Place> {
    PossibleValuesParser::new(Place::ALL.map(Place::name)).map(|word| {
        let known = Place::ALL.into_iter().find(|place| place.name() == word);
        known.unwrap_or(Place::Copper)
    })
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    engine: &'static str,
    seed: u64,
    moments: u16,
    holds: bool,
    faults: &'a [Outline],
}

/// Runs what is asked for.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::create(arguments.out.as_deref())?;
    let elf = arguments.elf.as_deref();
    let device = device::device(arguments.engine, elf)?;
    let device = device.as_ref();
    match arguments.modes {
        Modes {
            campaign: Some(count),
            ..
        } => campaign::run(arguments, device, 0..count),
        Modes {
            flips: Some(count), ..
        } => {
            let numbers = match arguments.replay {
                None => 0..count,
                Some(number) if number < count => number..number + 1,
                Some(number) => {
                    let problem = anyhow!(
                        "--replay {number}; --flips {count} has numbers 0 to {}",
                        count - 1
                    );
                    return Err(Failure::input(problem));
                }
            };
            flips::run(arguments, device, numbers)
        }
        Modes { pairs: true, .. } => pairs::run(arguments, device),
        Modes {
            normal: Some(hours),
            ..
        } => normal::run(arguments, device, hours),
        Modes { .. } => match arguments.replay {
            Some(number) => campaign::run(arguments, device, number..number + 1),
            None => matrix(arguments, device),
        },
    }
}

/// Runs the matrix, prints it, writes its page; a fault that does not hold is a failure.
fn matrix(arguments: &Arguments, device: &dyn Device) -> Result<(), Failure> {
    let plan = Plan {
        entries: entries(&arguments.only)?,
        places: match arguments.scene.as_slice() {
            [] => Place::ALL.to_vec(),
            chosen => chosen.to_vec(),
        },
        moments: arguments.moments.into(),
        seed: arguments.seed,
    };
    let rows = outlines(arguments, &plan, device).map_err(Failure::run)?;
    let mut text = if arguments.json {
        let report = Report {
            engine: device.name(),
            seed: arguments.seed,
            moments: arguments.moments,
            holds: rows.iter().all(|row| row.holds),
            faults: &rows,
        };
        serde_json::to_string(&report).map_err(Failure::run)? + "\n"
    } else {
        faults::table(&rows)
    };
    if let Some(folder) = &arguments.out {
        output::write(folder, faults::HTML, faults::page(&rows, device.name()))
            .map_err(Failure::run)?;
        if !arguments.json {
            text += &format!("report: {}\n", folder.join(faults::HTML).display());
        }
    }
    output::print(&text)?;
    match rows.iter().filter(|row| !row.holds).count() {
        0 => Ok(()),
        failing => Err(Failure::run(anyhow!(
            "{failing} of {} faults do not hold",
            rows.len()
        ))),
    }
}

/// The rows of the chosen kinds.
fn entries(only: &[String]) -> Result<Vec<Entry>, Failure> {
    let all = faults::entries();
    for kind in only {
        if !all.iter().any(|entry| entry.fault.kind() == *kind) {
            let mut known: Vec<_> = all.iter().map(|entry| entry.fault.kind()).collect();
            known.dedup();
            let problem = anyhow!("--only {kind}; known are {}", known.join(", "));
            return Err(Failure::input(problem));
        }
    }
    let chosen = |entry: &Entry| only.is_empty() || only.contains(&entry.fault.kind());
    Ok(all.into_iter().filter(chosen).collect())
}

fn outlines(
    arguments: &Arguments,
    plan: &Plan,
    device: &dyn Device,
) -> anyhow::Result<Vec<Outline>> {
    let trials = each(
        arguments,
        "faults",
        device,
        &plan.runs(),
        |(row, moment)| {
            let entry = &plan.entries[*row];
            Ok((*row, Trial::run(device, entry, *moment, plan.seed)?))
        },
    );
    let mut by_row: Vec<Vec<Trial>> = plan.entries.iter().map(|_| Vec::new()).collect();
    for (row, trial) in trials? {
        by_row[row].extend(trial);
    }
    let rows = plan.entries.iter().zip(by_row);
    Ok(rows
        .map(|(entry, trials)| Outline::new(entry, trials))
        .collect())
}

/// Prints a report as one object if that is asked for, else as its table.
fn tell(
    arguments: &Arguments,
    report: &impl Serialize,
    table: impl FnOnce() -> String,
) -> Result<(), Failure> {
    let text = if arguments.json {
        serde_json::to_string(report).map_err(Failure::run)? + "\n"
    } else {
        table()
    };
    output::print(&text)
}

/// Does the work of every item on the threads that are asked for, and shows how far it is; where no terminal is, a line
/// for every twentieth.
fn each<T: Sync, R: Send>(
    arguments: &Arguments,
    what: &str,
    device: &dyn Device,
    items: &[T],
    work: impl Fn(&T) -> anyhow::Result<R> + Sync,
) -> anyhow::Result<Vec<R>> {
    let style =
        ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}  {elapsed} of {duration}")?;
    let bar = ProgressBar::new(items.len() as u64).with_style(style);
    bar.set_message(format!("{what} on engine {}", device.name()));
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or_else(cores, usize::from);
    let twentieth = |count: usize| count * 20 / items.len().max(1);
    let done = AtomicUsize::new(0);
    let results = map(items, threads, work, || {
        bar.inc(1);
        let before = done.fetch_add(1, Ordering::Relaxed);
        if bar.is_hidden() && twentieth(before) != twentieth(before + 1) {
            eprintln!(
                "{what}: {} of {} in {:.0} s",
                before + 1,
                items.len(),
                bar.elapsed().as_secs_f64()
            );
        }
    });
    bar.finish_and_clear();
    results
}

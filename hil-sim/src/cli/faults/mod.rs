//! `hil-sim faults`: the fault matrix, random campaigns, pairs, normal use and bit flips.

mod campaign;
mod five_fingers;
mod flips;
mod normal;
mod pairs;
mod sound;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::anyhow;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use thermal_campaigns::faults::{
    self, FaultCase, FaultRun, FaultScene, FaultSummary, MatrixPlan, Strict,
};
use thermal_campaigns::parallel_map;
use thermal_sim::SceneRunner;

use super::engine::{self, EngineKind};
use super::{Failure, output};

#[derive(Args)]
pub struct Arguments {
    /// Faults of these kinds only, such as thermistor-open
    #[arg(long, num_args = 1.., value_name = "KIND")]
    only: Vec<String>,
    /// In these scenes only; of one finger
    #[arg(long, num_args = 1.., value_parser = scenes())]
    scene: Vec<FaultScene>,
    /// On the device for so many fingers only, 1 or 5 [default: on both, but with --scene or --elf on that for 1]
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=5).try_map(one_or_five))]
    fingers: Option<u8>,
    /// Moments of each fault, spread over the scenes
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..))]
    moments: u16,
    /// Of moments, of the order of scenes, and of the device's converter
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// What runs the device's logic
    #[arg(long, value_enum, default_value_t = EngineKind::DEFAULT)]
    engine: EngineKind,
    /// On an emulator that checks more and is slower, with a slow flash and the low-speed oscillator at 17 or 47 kHz
    #[arg(long)]
    strict: bool,
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
    /// With --normal: displays with a heat-flux sensor, and drawn fingers that the device learns
    #[arg(long, requires = "normal")]
    flux_sensor: bool,
    /// Again the campaign of a number, or with --flips the flip; its scene goes to --out
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(..10_000_000),
        conflicts_with_all = ["only", "scene", "moments", "fingers", "campaign", "pairs", "normal", "sound"])]
    replay: Option<u64>,
}

/// The mode that replaces the matrix; at most one.
#[derive(Args)]
#[group(multiple = false, conflicts_with_all = ["only", "scene", "moments", "fingers"])]
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
    /// N random campaigns without a fault (commands, finger, device, tuned or not), in which the display's surface stays within
    /// 14 to 43 C and the skin within 14 to 42.5 C; scenes of those in which they do not go to --out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    sound: Option<u64>,
}

fn one_or_five(fingers: u8) -> Result<u8, String> {
    match fingers {
        1 | 5 => Ok(fingers),
        _ => Err("allowed are 1 and 5".into()),
    }
}

fn scenes() -> impl TypedValueParser<Value = FaultScene> {
    PossibleValuesParser::new(FaultScene::ALL.map(FaultScene::name)).map(|word| {
        let known = FaultScene::ALL.into_iter().find(|place| place.name() == word);
        known.unwrap_or(FaultScene::Copper)
    })
}

/// What `--json` prints of the matrix.
#[derive(Serialize)]
struct MatrixReport<'a> {
    engine: &'static str,
    seed: u64,
    moments: u16,
    holds: bool,
    faults: &'a [FaultSummary],
    /// On the device for five fingers.
    five_fingers: &'a [FaultSummary],
}

/// What `--json` prints of the other modes.
struct RunsReport<'a, R> {
    /// Name of the engine, unless the mode has only one.
    engine: Option<&'static str>,
    seed: u64,
    /// Number of runs that broke a limit.
    failing: usize,
    /// Key of the list of runs.
    key: &'static str,
    runs: &'a [R],
}

impl<R: Serialize> Serialize for RunsReport<'_, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if let Some(engine) = self.engine {
            map.serialize_entry("engine", engine)?;
        }
        map.serialize_entry("seed", &self.seed)?;
        map.serialize_entry("holds", &(self.failing == 0))?;
        map.serialize_entry(self.key, self.runs)?;
        map.end()
    }
}

impl<R: Serialize> RunsReport<'_, R> {
    /// Prints the runs; runs that broke a limit make the command fail with the text of `problem`.
    fn print(
        &self,
        arguments: &Arguments,
        table: fn(&[R]) -> String,
        problem: String,
    ) -> Result<(), Failure> {
        output::print_report(arguments.json, self, || table(self.runs), None)?;
        match self.failing {
            0 => Ok(()),
            failing => Err(Failure::run(anyhow!("{failing} of {} {problem}", self.runs.len()))),
        }
    }
}

/// Runs the chosen mode.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::create(arguments.out.as_deref())?;
    let elf = arguments.elf.as_deref();
    let mut device = engine::runner(arguments.engine, elf)?;
    if arguments.strict {
        if !device.has_processor() {
            let problem = anyhow!("--strict; the engine {} has no processor", device.name());
            return Err(Failure::input(problem));
        }
        device = Box::new(Strict(device));
    }
    let device = device.as_ref();
    match arguments.modes {
        Modes { campaign: Some(count), .. } => campaign::run(arguments, device, 0..count),
        Modes { flips: Some(count), .. } => {
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
        Modes { normal: Some(hours), .. } => normal::run(arguments, device, hours),
        Modes { sound: Some(count), .. } => sound::run(arguments, device, count),
        Modes { .. } => match arguments.replay {
            Some(number) => campaign::run(arguments, device, number..number + 1),
            None => matrix(arguments, device),
        },
    }
}

/// Runs the matrix, prints it and writes its page; a fault that does not hold is a failure.
fn matrix(arguments: &Arguments, device: &dyn SceneRunner) -> Result<(), Failure> {
    let (has_one, has_five) = match arguments.fingers {
        Some(fingers) => (fingers == 1, fingers != 1),
        None => (true, arguments.scene.is_empty() && arguments.elf.is_none()),
    };
    let [one_cases, five_cases] =
        [(has_one, faults::fault_cases as fn() -> _), (has_five, faults::five_finger_cases)]
            .map(|(chosen, cases)| if chosen { cases() } else { Vec::new() });
    let (one_cases, five_cases) = of_kinds(&arguments.only, one_cases, five_cases)?;
    let plan = MatrixPlan {
        fault_cases: one_cases,
        scenes: match arguments.scene.as_slice() {
            [] => FaultScene::ALL.to_vec(),
            chosen => chosen.to_vec(),
        },
        moments: arguments.moments.into(),
        seed: arguments.seed,
    };
    let rows = outlines(arguments, &plan, device).map_err(Failure::run)?;
    let five_rows = five_fingers::outlines(arguments, five_cases)?;
    let all = || rows.iter().chain(&five_rows);
    let report = MatrixReport {
        engine: device.name(),
        seed: arguments.seed,
        moments: arguments.moments,
        holds: all().all(|row| row.holds),
        faults: &rows,
        five_fingers: &five_rows,
    };
    let sections = [("One finger", rows.as_slice()), ("Five fingers", &five_rows)];
    let sections = sections.into_iter().filter(|(_, rows)| !rows.is_empty());
    let sections: Vec<_> = sections.collect();
    let page = arguments.out.as_ref();
    if let Some(folder) = page {
        output::write(folder, faults::HTML, faults::page(&sections, device.name()))
            .map_err(Failure::run)?;
    }
    let table = || {
        let tables =
            sections.iter().map(|(title, rows)| format!("{title}\n{}", faults::table(rows)));
        tables.collect::<Vec<_>>().join("\n")
    };
    let page = page.map(|folder| folder.join(faults::HTML));
    output::print_report(arguments.json, &report, table, page)?;
    match all().filter(|row| !row.holds).count() {
        0 => Ok(()),
        failing => Err(Failure::run(anyhow!("{failing} of {} faults do not hold", all().count()))),
    }
}

/// The cases of the chosen kinds, of one finger and of five.
fn of_kinds(
    only: &[String],
    mut one: Vec<FaultCase>,
    mut five: Vec<FaultCase>,
) -> Result<(Vec<FaultCase>, Vec<FaultCase>), Failure> {
    let mut known: Vec<_> =
        (one.iter().chain(&five)).map(|fault_case| fault_case.fault.kind()).collect();
    if let Some(kind) = only.iter().find(|kind| !known.contains(kind)) {
        known.sort();
        known.dedup();
        let problem = anyhow!("--only {kind}; known are {}", known.join(", "));
        return Err(Failure::input(problem));
    }
    let chosen =
        |fault_case: &FaultCase| only.is_empty() || only.contains(&fault_case.fault.kind());
    one.retain(chosen);
    five.retain(chosen);
    Ok((one, five))
}

fn outlines(
    arguments: &Arguments,
    plan: &MatrixPlan,
    device: &dyn SceneRunner,
) -> anyhow::Result<Vec<FaultSummary>> {
    let trials = each(arguments, "faults", device.name(), &plan.runs(), |run| {
        Ok((run.row, run.run(device)?))
    });
    let mut by_row: Vec<Vec<FaultRun>> = plan.fault_cases.iter().map(|_| Vec::new()).collect();
    for (row, trial) in trials? {
        by_row[row].extend(trial);
    }
    let rows = plan.fault_cases.iter().zip(by_row);
    Ok(rows.map(|(fault_case, trials)| FaultSummary::new(fault_case, trials)).collect())
}

/// Processes the items on the chosen number of threads with a progress bar; without a terminal, prints a line for every
/// twentieth of the items.
fn each<T: Sync, R: Send>(
    arguments: &Arguments,
    what: &str,
    engine: &str,
    items: &[T],
    work: impl Fn(&T) -> anyhow::Result<R> + Sync,
) -> anyhow::Result<Vec<R>> {
    let bar = output::run_counter(format!("{what} on engine {engine}"), items.len())?;
    let threads = output::threads(arguments.threads);
    let twentieth = |count: usize| count * 20 / items.len().max(1);
    let done = AtomicUsize::new(0);
    let results = parallel_map(items, threads, work, || {
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

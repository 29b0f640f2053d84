//! `cargo xtask fuzz`: libFuzzer on every interface that takes external input.
mod coverage;
mod engine;
mod instrument;
mod progress;

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};
use clap::{Args, ValueEnum};

pub use instrument::compile_if_called_as_compiler;

use crate::process::workspace;
use crate::setup::{self, Needs, Permission};
use engine::{Effort, Engine};
use instrument::Instrumented;

/// Fuzz targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Bytes from the host, and ticks
    Wire,
    /// Lines from the host without ticks
    Lines,
    /// Samples and command lines
    Station,
    /// Settings that command lines can set, and readings corrected by them
    Settings,
    /// Damage, records and saves in the settings' flash
    Flash,
    /// The text of a scene file
    Scene,
}

impl Target {
    fn name(self) -> &'static str {
        match self {
            Self::Wire => "wire",
            Self::Lines => "lines",
            Self::Station => "station",
            Self::Settings => "settings",
            Self::Flash => "flash",
            Self::Scene => "scene",
        }
    }

    /// Folder of the repository's inputs for the target.
    fn corpus(self) -> PathBuf {
        workspace().join("tests/fuzz/corpus").join(self.name())
    }

    /// Folders of initial inputs.
    fn seeds(self) -> Vec<PathBuf> {
        let mut seeds = vec![self.corpus()];
        if self == Self::Scene {
            seeds.push(workspace().join("scenes"));
        }
        seeds
    }

    /// Dictionary of words for inputs.
    fn dictionary(self) -> Option<PathBuf> {
        let words = match self {
            // The words of the protocol are the same with and without ticks.
            Self::Lines => Self::Wire,
            other => other,
        };
        let path = workspace().join(format!("tests/fuzz/{}.dict", words.name()));
        path.is_file().then_some(path)
    }

    /// Largest size of an input, bytes.
    const fn longest(self) -> u32 {
        match self {
            // Some lines, so that an execution is short.
            Self::Lines => 160,
            _ => 1024,
        }
    }
}

/// Options of `cargo xtask fuzz`.
#[derive(Args)]
pub struct Options {
    /// What to fuzz, may be repeated [default: all]
    #[arg(long, value_enum)]
    target: Vec<Target>,
    /// Time for each target, s
    #[arg(long, default_value_t = 60, conflicts_with = "runs")]
    seconds: u64,
    /// Executions for each target instead of a time
    #[arg(long)]
    runs: Option<u64>,
    /// Processes for each target, which share what they find; as many targets run side by side as the cores allow
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=64))]
    jobs: u64,
    /// Run this one input of the one target and print its decoded form
    #[arg(long, value_name = "FILE", requires = "target", group = "other")]
    replay: Option<PathBuf>,
    /// Replace the repository's corpus by the smallest set of known inputs with the same coverage
    #[arg(long, group = "other")]
    keep: bool,
    /// Print the coverage of each source file by all inputs (needs llvm-tools)
    #[arg(long, group = "other")]
    coverage: bool,
}

/// Folder for files of builds and runs.
fn folder() -> PathBuf {
    workspace().join("target/fuzz")
}

/// Folder of the inputs found for a target in runs on this machine.
fn found(target: Target) -> Result<PathBuf> {
    let path = folder().join("corpus").join(target.name());
    create(&path)?;
    Ok(path)
}

fn create(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).with_context(|| format!("{}: cannot be made", path.display()))
}

/// `cargo xtask fuzz`
pub fn run(permission: Permission, options: &Options) -> Result<()> {
    let needs = Needs { fuzzer: true, ..Needs::default() };
    setup::prepare(needs, permission)?;
    let targets = match options.target.as_slice() {
        [] => Target::value_variants(),
        some => some,
    };
    if options.coverage {
        return coverage::report(targets);
    }
    let engine = Engine::new(&Instrumented::Fuzzing.build()?)?;
    if let Some(input) = &options.replay {
        let [target] = targets else {
            bail!("--replay needs one --target");
        };
        return engine.replay(*target, input);
    }
    if options.keep {
        return targets.iter().try_for_each(|target| engine.keep(*target));
    }
    let effort = match options.runs {
        Some(runs) => Effort::Runs(runs),
        None => Effort::Time(Duration::from_secs(options.seconds)),
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let at_once = cores.div_ceil(usize::try_from(options.jobs)?);
    let mut lines = Vec::new();
    let mut total = 0;
    for group in targets.chunks(at_once) {
        let fuzz = |target: &Target| engine.fuzz(*target, effort, options.jobs);
        let results: Vec<_> = std::thread::scope(|scope| {
            let running = group.iter().map(|target| scope.spawn(|| fuzz(target)));
            let running: Vec<_> = running.collect();
            running.into_iter().map(|thread| thread.join()).collect()
        });
        for (target, result) in group.iter().zip(results) {
            let reached = result.map_err(|_| anyhow!("{}: panicked", target.name()))??;
            total += reached.progress.executions;
            lines.push(format!("{:<10}{reached}", target.name()));
        }
    }
    println!(
        "{:<10}{:>14}{:>10}{:>8}{:>10}{:>8}",
        "target", "executions", "per s", "edges", "features", "inputs"
    );
    lines.iter().for_each(|line| println!("{line}"));
    println!("{:<10}{total:>14}   without a crash or a hang", "total");
    Ok(())
}

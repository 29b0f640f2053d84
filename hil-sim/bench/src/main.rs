//! The benchmark: run time against error of `erfcx` and of the whole model, on this host and on the emulated
//! microcontroller; of the simulated plant, and of whole runs on both engines, on this host. Results on standard output, progress on standard error.

mod host;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use clap::{Parser, ValueEnum};

/// Subject of the benchmark.
#[derive(Clone, Copy, ValueEnum)]
enum Job {
    /// The contact model and its peers
    Model,
    /// The simulated plant, on this host
    Plant,
    /// A whole scene on the native engine and on the image
    Engines,
}

/// Run time against error of the contact model and its peers, or of the simulated plant, or of both engines.
#[derive(Parser)]
#[command(name = "model-bench", max_term_width = 100)]
struct Arguments {
    /// Subject of the benchmark
    #[arg(value_enum, default_value = "model")]
    job: Job,
    /// Print one JSON object in place of the tables
    #[arg(long)]
    json: bool,
    /// Folder for the page and its picture: benchmark.md and benchmark.svg, or plant-benchmark.md and plant-benchmark.svg
    #[arg(long, default_value = "target/bench")]
    out: PathBuf,
    /// Inputs whose error is taken, of the model
    #[arg(long, default_value_t = 100_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    inputs: u32,
    /// Rounds of timing on this host
    #[arg(long, default_value_t = 101, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    rounds: u16,
}

/// Results of a benchmark.
struct Results {
    /// One JSON object.
    json: String,
    tables: String,
    /// Names and contents of files.
    files: Vec<(&'static str, String)>,
}

fn model(arguments: &Arguments, progress: impl Fn(&str)) -> anyhow::Result<Results> {
    let effort = host::Effort { inputs: arguments.inputs, rounds: arguments.rounds.into() };
    let figures = host::measure(effort, progress)?;
    Ok(Results {
        json: serde_json::to_string_pretty(&figures)?,
        tables: host::tables(&figures),
        files: vec![
            ("benchmark.md", host::page(&figures)),
            ("benchmark.svg", host::draw(&figures)?),
        ],
    })
}

fn plant(arguments: &Arguments, progress: impl Fn(&str)) -> anyhow::Result<Results> {
    let figures = host::plant::measure(arguments.rounds.into(), progress)?;
    Ok(Results {
        json: serde_json::to_string_pretty(&figures)?,
        tables: host::plant::tables(&figures),
        files: vec![
            ("plant-benchmark.md", host::plant::page(&figures)),
            ("plant-benchmark.svg", host::plant::draw(&figures)?),
        ],
    })
}

fn engines(arguments: &Arguments, progress: impl Fn(&str)) -> anyhow::Result<Results> {
    let figures = host::engines::measure(arguments.rounds.into(), progress)?;
    Ok(Results {
        json: serde_json::to_string_pretty(&figures)?,
        tables: host::engines::table(&figures),
        files: Vec::new(),
    })
}

fn run(arguments: &Arguments) -> anyhow::Result<()> {
    // Fails before the measurements if the folder cannot be written.
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).with_context(|| format!("--out {}", folder.display()))?;
    let progress = |what: &str| eprintln!("{what}");
    let results = match arguments.job {
        Job::Model => model(arguments, progress)?,
        Job::Plant => plant(arguments, progress)?,
        Job::Engines => engines(arguments, progress)?,
    };
    if arguments.json {
        println!("{}", results.json);
    } else {
        print!("{}", results.tables);
    }
    for (name, text) in results.files {
        let path = folder.join(name);
        std::fs::write(&path, text).with_context(|| path.display().to_string())?;
        eprintln!("wrote {}", path.display());
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("model-bench: {error:#}");
            ExitCode::FAILURE
        }
    }
}

//! The benchmark: run time against error of `erfcx` and of the whole model, on this host and on the emulated
//! microcontroller. Results on standard output, progress on standard error.

mod host;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use clap::Parser;

/// Run time against error of the contact model and its peers.
#[derive(Parser)]
#[command(name = "model-bench", max_term_width = 100)]
struct Arguments {
    /// Print one JSON object in place of the tables
    #[arg(long)]
    json: bool,
    /// Folder for benchmark.md and benchmark.svg
    #[arg(long, default_value = "target/bench")]
    out: PathBuf,
    /// Inputs whose error is taken
    #[arg(long, default_value_t = 100_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    inputs: u32,
    /// Rounds of timing on this host
    #[arg(long, default_value_t = 101, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    rounds: u16,
}

fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let effort = host::Effort {
        inputs: arguments.inputs,
        rounds: arguments.rounds.into(),
    };
    // Before time is spent on what cannot be written.
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).with_context(|| format!("--out {}", folder.display()))?;
    let figures = host::measure(effort, |what| eprintln!("{what}"))?;
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&figures)?);
    } else {
        print!("{}", host::tables(&figures));
    }
    for (name, text) in [
        ("benchmark.md", host::page(&figures)),
        ("benchmark.svg", host::draw(&figures)?),
    ] {
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

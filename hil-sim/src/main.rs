//! The `hil-sim` command. Results on standard output, progress on standard error; exit status 1 if a run
//! fails, 2 for bad input.

mod cli;

use std::process::ExitCode;

use clap::Parser;

use cli::{Failure, erfcx, model, run, thesis};

/// Simulated plant and emulated microcontroller of the thermal display.
#[derive(Parser)]
#[command(name = "hil-sim", max_term_width = 100)]
enum Cli {
    /// Run a scene
    Run(run::Arguments),
    /// Evaluate the contact model (Eq. 6-5 to 6-12) and print CSV
    Model(model::Arguments),
    /// Evaluate the fixed-point kernel: one z a line on standard input, prints z and the bits of E
    Erfcx,
    /// Recompute the thesis's tables and model figures and lay them beside what it states
    Thesis(thesis::Arguments),
}

fn main() -> ExitCode {
    let done = match Cli::parse() {
        Cli::Run(arguments) => run::run(&arguments),
        Cli::Model(arguments) => model::run(&arguments),
        Cli::Erfcx => erfcx::run(),
        Cli::Thesis(arguments) => thesis::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { error, status }) => {
            eprintln!("hil-sim: {error:#}");
            ExitCode::from(status)
        }
    }
}

//! `hardware-benches`: simulates the circuits, prints a table or JSON; exit status 1 if a quantity is not allowed.
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hardware_benches::benches::{ALL, Bench};
use hardware_benches::netlist::Netlists;
use hardware_benches::ngspice;
use hardware_benches::quantity::{Quantity, Short};
use hardware_benches::schematic;
use serde::Serialize;

/// Simulate the circuits of hardware/ with ngspice and compare the results with what the firmware assumes
#[derive(Parser)]
struct Cli {
    /// Print one JSON object instead of the table
    #[arg(long)]
    json: bool,
    /// Run the bench of this name only, may be repeated
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Draw the netlists into this SVG file and simulate nothing
    #[arg(long, value_name = "FILE", exclusive = true)]
    schematic: Option<PathBuf>,
}

/// A bench's results for `--json`.
#[derive(Serialize)]
struct Report {
    bench: &'static str,
    title: &'static str,
    passed: bool,
    quantities: Vec<Quantity>,
}

/// Results of all benches for `--json`.
#[derive(Serialize)]
struct Reports {
    /// Null if nothing was simulated.
    passed: Option<bool>,
    skipped: Option<&'static str>,
    benches: Vec<Report>,
}

/// Why nothing was simulated.
const NO_NGSPICE: &str = "ngspice is not installed (apt-get install ngspice)";

fn main() -> ExitCode {
    match run(&Cli::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn chosen(only: &[String]) -> Result<Vec<Bench>> {
    let names: Vec<_> = ALL.iter().map(|bench| bench.name).collect();
    for name in only {
        let known = names.contains(&name.as_str());
        ensure!(known, "no bench {name}; there are {}", names.join(", "));
    }
    let wanted = |bench: &&Bench| only.is_empty() || only.iter().any(|name| name == bench.name);
    Ok(ALL.iter().filter(wanted).copied().collect())
}

/// Whether all benches have passed, or nothing could be simulated.
fn run(cli: &Cli) -> Result<bool> {
    if let Some(path) = &cli.schematic {
        fs::write(path, schematic::draw()?).with_context(|| path.display().to_string())?;
        return Ok(true);
    }
    let benches = chosen(&cli.only)?;
    let mut reports = Reports {
        passed: None,
        skipped: None,
        benches: Vec::new(),
    };
    if ngspice::is_installed() {
        let netlists = Netlists::load()?;
        for bench in benches {
            let quantities = (bench.run)(&netlists)?;
            let report = Report {
                bench: bench.name,
                title: bench.title,
                passed: quantities.iter().all(Quantity::holds),
                quantities,
            };
            if !cli.json {
                print_table(&report);
            }
            reports.passed = Some(reports.passed.unwrap_or(true) && report.passed);
            reports.benches.push(report);
        }
    } else {
        reports.skipped = Some(NO_NGSPICE);
    }
    let passed = reports.passed.unwrap_or(true);
    if cli.json {
        if let Some(why) = reports.skipped {
            eprintln!("skipped: {why}");
        }
        println!("{}", serde_json::to_string_pretty(&reports)?);
    } else if let Some(why) = reports.skipped {
        println!("skipped: {why}");
    } else {
        let verdict = if passed {
            "all simulated quantities are allowed"
        } else {
            "FAILED"
        };
        println!("{verdict}");
    }
    Ok(passed)
}

fn print_table(report: &Report) {
    println!("{} (simulated): {}", report.bench, report.title);
    let width = |text: &dyn Fn(&Quantity) -> String| {
        let widths = report
            .quantities
            .iter()
            .map(|quantity| text(quantity).chars().count());
        widths.max().unwrap_or(0)
    };
    let value = |quantity: &Quantity| format!("{} {}", Short(quantity.value), quantity.unit);
    let (names, values, limits) = (
        width(&|quantity| quantity.name.clone()),
        width(&value),
        width(&Quantity::allowed),
    );
    for quantity in &report.quantities {
        let verdict = if quantity.holds() { "ok" } else { "FAILED" };
        println!(
            "  {:names$}  {:>values$}  {:limits$}  {verdict}",
            quantity.name,
            value(quantity),
            quantity.allowed(),
        );
    }
    println!();
}

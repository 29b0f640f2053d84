//! `hardware-benches`: simulates the circuits, prints a table or JSON; exit status 1 if a quantity is not allowed.
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hardware_benches::benches::{ALL, Bench};
use hardware_benches::netlist::Netlists;
use hardware_benches::ngspice;
use hardware_benches::picture;
use hardware_benches::quantity::{Quantity, Short};
use hardware_benches::schematic;
use serde::Serialize;
use thermal_charts::{document, escape, svg_element};

/// Simulate the circuits of hardware/ with ngspice and compare the results with what the firmware assumes
#[derive(Parser)]
struct Cli {
    /// Print one JSON object instead of the table
    #[arg(long)]
    json: bool,
    /// Run the bench of this name only, may be repeated
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Write pictures of the simulated waveforms and a page with all results into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
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
    let mut reports = Reports { passed: None, skipped: None, benches: Vec::new() };
    if ngspice::is_installed() {
        let netlists = Netlists::load()?;
        for bench in benches {
            let quantities = bench.run(&netlists)?;
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
    if let (Some(folder), None) = (&cli.out, reports.skipped) {
        write_page(folder, &reports.benches)?;
    }
    if cli.json {
        if let Some(why) = reports.skipped {
            eprintln!("skipped: {why}");
        }
        println!("{}", serde_json::to_string_pretty(&reports)?);
    } else if let Some(why) = reports.skipped {
        println!("skipped: {why}");
    } else {
        let verdict = if passed { "all simulated quantities are allowed" } else { "FAILED" };
        println!("{verdict}");
    }
    Ok(passed)
}

/// Draws the pictures of these benches, and writes a page with their quantities.
fn write_page(folder: &Path, reports: &[Report]) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let netlists = Netlists::load()?;
    let mut body = String::from("<p>Simulated with ngspice; nobody has built this.</p>");
    for report in reports {
        body += &format!("<h2>{}: {}</h2>", report.bench, escape(report.title));
        let pictures = ALL.iter().find(|bench| bench.name == report.bench);
        for (name, scene) in pictures.map_or(&[][..], |bench| bench.pictures) {
            let svg = picture::draw(name, &netlists, &scene())?;
            thermal_charts::write(folder, &format!("{name}.svg"), &svg)?;
            body += svg_element(&svg);
        }
        body += "<table><tr><th>quantity</th><th>simulated</th><th>allowed</th></tr>";
        for quantity in &report.quantities {
            let (name, allowed) = (escape(&quantity.name), quantity.allowed());
            let (value, unit) = (Short(quantity.value), quantity.unit);
            body += &format!("<tr><td>{name}</td><td>{value} {unit}</td><td>{allowed}</td></tr>");
        }
        body += "</table>";
    }
    let page = document("Circuits", "", &body);
    thermal_charts::write(folder, "hardware.html", page)
}

fn print_table(report: &Report) {
    println!("{} (simulated): {}", report.bench, report.title);
    let width = |text: &dyn Fn(&Quantity) -> String| {
        let widths = report.quantities.iter().map(|quantity| text(quantity).chars().count());
        widths.max().unwrap_or(0)
    };
    let value = |quantity: &Quantity| format!("{} {}", Short(quantity.value), quantity.unit);
    let (names, values, limits) =
        (width(&|quantity| quantity.name.clone()), width(&value), width(&Quantity::allowed));
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

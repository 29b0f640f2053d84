//! `thermal-lab contact`: the contact law of a person's finger.

use std::fs;
use std::io::stderr;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;
use contact_law_fit::{Measurement, MeasurementOptions, Sample, Step, fit, force_n, measure};
use thermal_client::client::{Client, StationRequest};
use thermal_client::link::Link;
use thermal_lab::contact::Report;
use thermal_lab::step_screen::StepScreen;
use thermal_settings::PersonCode;

use super::{Failure, KeptFiles, Target, enrol, print_text};

#[derive(Args)]
pub struct Arguments {
    /// Code of the person, 1 to 8 of A to Z and 0 to 9; no name
    #[arg(value_parser = enrol::code)]
    code: PersonCode,
    /// Files to write: PATH.csv (recording), PATH.toml (result), PATH.svg (picture) [default: contact-CODE]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// Take the zero of the heat-flux sensor before, with the display at the room's temperature
    #[arg(long)]
    zero: bool,
    /// Tell the device of the law
    #[arg(long)]
    tell: bool,
    /// Finger of a device with several
    #[arg(long, value_name = "N")]
    finger: Option<u8>,
    #[command(flatten)]
    kept: KeptFiles,
}

/// What is written: the recording, the result and its picture.
const EXTENSIONS: [&str; 3] = ["csv", "toml", "svg"];

impl Arguments {
    /// A file that is written.
    fn file(&self, extension: &str) -> PathBuf {
        let path = match &self.out {
            Some(path) => path.clone(),
            None => format!("contact-{}", self.code).into(),
        };
        path.with_added_extension(extension)
    }
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    EXTENSIONS.iter().try_for_each(|extension| arguments.kept.check(&arguments.file(extension)))?;
    let mut out = stderr();
    let mut screen = StepScreen::new(&mut out);
    if target.simulated {
        // The simulated finger follows the ramps exactly.
        return target.with_device_of_scene("contact", |client| {
            at_device(client, arguments, &mut |client, step| {
                screen.show(step);
                let world = client.link().world();
                world.set_force_and_faults(step.target_n(), std::iter::empty());
            })
        });
    }
    target.with_client(|client| at_device(client, arguments, &mut |_, step| screen.show(step)))
}

fn at_device<L: Link>(
    client: &mut Client<L>,
    arguments: &Arguments,
    guide: &mut dyn FnMut(&mut Client<L>, &Step),
) -> Result<(), Failure> {
    let options = MeasurementOptions { finger: arguments.finger, takes_zero: arguments.zero };
    let measurement = measure(client, &options, guide).map_err(Failure::run)?;
    let [recording, result, picture] = EXTENSIONS.map(|extension| arguments.file(extension));
    // What was recorded is kept even if nothing fits it.
    write(&recording, &csv(&measurement))?;
    let fit = fit(&measurement.recording).map_err(Failure::run)?;
    let report = Report::new(&arguments.code.to_string(), &measurement, &fit);
    write(&result, &toml::to_string(&report).map_err(Failure::run)?)?;
    let chart = report.chart(&measurement.recording, &fit);
    write(&picture, &chart.map_err(Failure::run)?)?;
    print_text(&report.text())?;
    if arguments.tell {
        let command = StationRequest::contact_law(fit.law);
        (client.ask_finger(arguments.finger, &command)).map_err(Failure::run)?;
    }
    Ok(())
}

/// The samples as CSV.
fn csv(measurement: &Measurement) -> String {
    let row = |sample: &Sample| {
        let Sample { since_s, flux_w_m2, surface_c, force_n: pressed_n } = sample;
        let target_n = force_n(*since_s).unwrap_or_default();
        format!("{since_s:.3},{flux_w_m2},{surface_c},{pressed_n},{target_n:.4}\n")
    };
    let rows: String = measurement.recording.samples.iter().map(row).collect();
    format!("since_s,flux_w_m2,surface_c,force_n,target_n\n{rows}")
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    fs::write(path, text).with_context(|| format!("--out {}", path.display())).map_err(Failure::run)
}

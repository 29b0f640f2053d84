//! `thermal-lab commission`: by the person at the bench, or by the simulated operator of a simulated device.

use std::io::{BufReader, Write, stderr, stdin};

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_client::client::{Client, PlainCommand};
use thermal_client::commissioning::{CommissioningEvent, CommissioningRecord};
use thermal_lab::bench_operator::{BenchOperator, WATCHED_STREAM_MS, lines};
use thermal_lab::commissioning::{clear_calibration, commission};
use thermal_lab::link::{ServedLink, ServedOperator};
use thermal_sim::engine::NativeEngine;

use super::{Failure, Target, print};

#[derive(Args)]
pub struct Arguments {
    /// The finger, on a device with several
    #[arg(long, value_name = "N")]
    finger: Option<u8>,
    /// Surroundings of a device that `hil-sim serve --surroundings` serves at `--tcp`: baths and reference thermometer are
    /// simulated there, and nobody is asked
    #[arg(long, value_name = "ADDR")]
    surroundings: Option<String>,
    /// Print one JSON object: points, tile with margins, settings
    #[arg(long)]
    json: bool,
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let record = match (&arguments.surroundings, &target.tcp) {
        (Some(surroundings), Some(device)) => served(device, surroundings, arguments)?,
        (Some(_), None) => {
            return Err(Failure::input(anyhow!(
                "--surroundings is for a device that is served at --tcp ADDR"
            )));
        }
        _ if target.simulated => simulated(target)?,
        _ => by_a_person(target, arguments)?,
    };
    if arguments.json {
        let text = serde_json::to_string(&record).map_err(Failure::run)?;
        return print(&text);
    }
    print(&record.settings.join("\n"))
}

/// On a device at a bench.
fn by_a_person(target: &Target, arguments: &Arguments) -> Result<CommissioningRecord, Failure> {
    let mut screen = stderr();
    let mut person = BenchOperator::new(
        arguments.finger,
        lines(BufReader::new(stdin())),
        &mut screen,
    );
    target.with_client(|client| {
        clear_calibration(client, arguments.finger).map_err(Failure::run)?;
        (client.ask_finger(arguments.finger, &PlainCommand::stream(WATCHED_STREAM_MS)))
            .map_err(Failure::run)?;
        commission(client, arguments.finger, &mut person).map_err(Failure::run)
    })
}

/// On a device that another program serves with its surroundings.
fn served(
    device: &str,
    surroundings: &str,
    arguments: &Arguments,
) -> Result<CommissioningRecord, Failure> {
    let link = ServedLink::connect(device, surroundings)
        .with_context(|| format!("--tcp {device} --surroundings {surroundings}"))
        .map_err(Failure::input)?;
    let mut client = Client::new(link);
    let mut operator = ServedOperator {
        watch: &mut print_event,
    };
    commission(&mut client, arguments.finger, &mut operator).map_err(Failure::run)
}

/// On a device that is simulated here.
fn simulated(target: &Target) -> Result<CommissioningRecord, Failure> {
    let setup = target.simulated_setup()?;
    let mut engine = NativeEngine::new(setup.in_use().map_err(Failure::input)?);
    thermal_sim::commissioning::commission(&setup, &mut engine, &mut print_event)
        .map_err(Failure::run)
}

/// Prints an event on standard error, which may be closed.
fn print_event(event: &CommissioningEvent) {
    let _ignored = writeln!(stderr(), "{event}");
}

//! `thermal-lab commission`: by the person at the bench, or by the simulated operator of a simulated device.

use std::io::{BufReader, Write, stderr, stdin};

use anyhow::anyhow;
use clap::Args;
use serde::Serialize;
use thermal_client::client::{Client, SessionRequest, StationRequest};
use thermal_client::commissioning::{
    CommissionError, CommissioningEvent, CommissioningRecord, FluxCalibration, Surroundings,
};
use thermal_client::link::Link;
use thermal_lab::bench_operator::{BenchOperator, WATCHED_STREAM_MS, lines};
use thermal_lab::bring_up::EmulatedBench;
use thermal_lab::commissioning::{clear_calibration, commission, commission_flux_sensor};
use thermal_lab::link::SimulatedLink;
use thermal_settings::FluxSensor;
use thermal_sim::commissioning::{SimulatedOperator, SimulatedSurroundings};
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
    /// Calibrate only the heat-flux sensor, with a phantom: of a device that is commissioned otherwise and has one set
    #[arg(long)]
    only_flux_sensor: bool,
    /// Print one JSON object: points, tile with margins, heat-flux sensor, settings
    #[arg(long)]
    json: bool,
}

/// What was found.
#[derive(Serialize)]
#[serde(untagged)]
enum Record {
    All(CommissioningRecord),
    FluxSensor { flux: FluxCalibration, settings: Vec<String> },
}

impl Record {
    fn settings(&self) -> &[String] {
        match self {
            Self::All(record) => &record.settings,
            Self::FluxSensor { settings, .. } => settings,
        }
    }
}

impl Arguments {
    /// Commissions the device, or its heat-flux sensor only.
    fn commission<L: Link>(
        &self,
        client: &mut Client<L>,
        surroundings: &mut dyn Surroundings<L>,
    ) -> Result<Record, CommissionError> {
        if self.only_flux_sensor {
            let (flux, settings) = commission_flux_sensor(client, self.finger, surroundings)?;
            return Ok(Record::FluxSensor { flux, settings });
        }
        commission(client, self.finger, surroundings).map(Record::All)
    }
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let record = match &arguments.surroundings {
        Some(surroundings) => served(target, surroundings, arguments)?,
        _ if target.simulated && arguments.only_flux_sensor => {
            return Err(Failure::input(anyhow!(
                "--only-flux-sensor is for a device that is commissioned; that of --simulated is not"
            )));
        }
        _ if target.simulated => simulated(target, arguments)?,
        _ => by_a_person(target, arguments)?,
    };
    if arguments.json {
        let text = serde_json::to_string(&record).map_err(Failure::run)?;
        return print(&text);
    }
    print(&record.settings().join("\n"))
}

/// On a device at a bench.
fn by_a_person(target: &Target, arguments: &Arguments) -> Result<Record, Failure> {
    let mut screen = stderr();
    let mut person =
        BenchOperator::new(arguments.finger, lines(BufReader::new(stdin())), &mut screen);
    target.with_client(|client| {
        if !arguments.only_flux_sensor {
            clear_calibration(client, arguments.finger).map_err(Failure::run)?;
        }
        (client.ask_finger(arguments.finger, &StationRequest::stream(WATCHED_STREAM_MS)))
            .map_err(Failure::run)?;
        (arguments.commission(client, &mut person)).map_err(Failure::run)
    })
}

/// On a device that another program serves with its surroundings.
fn served(target: &Target, surroundings: &str, arguments: &Arguments) -> Result<Record, Failure> {
    let mut operator = EmulatedBench { watch: &mut print_line };
    target.with_served_client(surroundings, |client| {
        arguments.commission(client, &mut operator).map_err(Failure::run)
    })
}

/// On a device that is simulated here. It is told of the heat-flux sensor of its scene.
fn simulated(target: &Target, arguments: &Arguments) -> Result<Record, Failure> {
    let setup = target.simulated_setup()?;
    let mut engine = NativeEngine::new(setup.in_use().map_err(Failure::input)?);
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    if setup.params().flux.is_some() {
        let sensor = SessionRequest::flux_sensor(Some(FluxSensor::DESIGNED));
        client.ask(&sensor).map_err(Failure::run)?;
    }
    let mut operator = SimulatedOperator {
        surroundings: SimulatedSurroundings::new(&setup),
        watch: &mut |event: &CommissioningEvent| print_line(&event.to_string()),
    };
    (arguments.commission(&mut client, &mut operator)).map_err(Failure::run)
}

/// Prints a line of progress on standard error, which may be closed.
fn print_line(line: &str) {
    let _ignored = writeln!(stderr(), "{line}");
}

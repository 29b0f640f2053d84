//! `hil-sim parameters`: the parameter box, as CSV or JSON.

use std::io::{Write, stdout};

use clap::{Args, ValueEnum};
use thermal_plant::Params;
use thermal_plant::finger::FingerParams;
use thermal_plant::parameters::{self, Parameter};
use thermal_plant::sensors::FluxParams;

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// Draw every value within its tolerance, by this seed
    #[arg(long)]
    draw: Option<u64>,
    /// Tissue of the finger
    #[arg(long, value_enum, default_value_t = Tissue::Homogeneous)]
    tissue: Tissue,
    /// With a heat-flux sensor on the display
    #[arg(long)]
    flux_sensor: bool,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Tissue {
    /// The thesis's half-space
    Homogeneous,
    /// Epidermis, dermis and fat, with blood
    Layered,
}

/// Prints the box. Limits are those around the nominal values, drawn or not.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut params = Params::nominal();
    if arguments.tissue == Tissue::Layered {
        params.finger = FingerParams::layered();
    }
    params.flux = arguments.flux_sensor.then_some(FluxParams::NOMINAL);
    let mut all = parameters::all(&params);
    if let Some(seed) = arguments.draw {
        parameters::draw(&mut params, seed);
        for (nominal, drawn) in all.iter_mut().zip(parameters::all(&params)) {
            nominal.value = drawn.value;
        }
    }
    let text = if arguments.json {
        serde_json::to_string(&all).map_err(Failure::run)? + "\n"
    } else {
        csv(&all).map_err(Failure::run)?
    };
    stdout().write_all(text.as_bytes()).map_err(Failure::run)
}

fn csv(all: &[Parameter]) -> anyhow::Result<String> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for parameter in all {
        csv.serialize(parameter)?;
    }
    Ok(String::from_utf8(csv.into_inner()?)?)
}

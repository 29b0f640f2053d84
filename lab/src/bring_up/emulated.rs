//! The bench of an emulated board: hands and instruments are lines to its surroundings.

use std::time::Duration;

use thermal_client::client::Client;
use thermal_client::commissioning::{
    BenchRequest, CommissioningEvent, Part, PhantomPlace, Surroundings, SurroundingsError,
    SurroundingsRequest,
};
use thermal_client::link::Link;
use thermal_device::safety::ThermistorId;

use super::bench::{Bench, BenchError, Measurement};
use super::check::{ManualStep, Stage};
use super::report::Record;
use crate::link::AskSurroundings;

/// Step by which a resistor is turned, as a fraction of its value: 0.05 K.
const TURN_STEP: f64 = 0.002;
/// Time between two steps: the comparator and the next tick have seen it by then.
const TURN_MS: u64 = 5;

/// The bench of an emulated board. `watch` is called for each result and each event, as one line.
pub struct EmulatedBench<'a> {
    /// Called for each line of progress.
    pub watch: &'a mut dyn FnMut(&str),
}

fn ask<L: AskSurroundings + Link>(
    client: &mut Client<L>,
    request: BenchRequest,
) -> Result<String, BenchError> {
    let link = client.link();
    link.ask_surroundings(&SurroundingsRequest::Bench(request)).map_err(BenchError::Failed)
}

fn parse(line: &str) -> Result<BenchRequest, BenchError> {
    line.parse().map_err(BenchError::Failed)
}

impl<L: AskSurroundings + Link> Bench<L> for EmulatedBench<'_> {
    fn begin(&mut self, stage: &Stage) {
        (self.watch)(stage.title);
    }

    fn act(&mut self, client: &mut Client<L>, manual: &ManualStep) -> Result<(), BenchError> {
        for line in manual.lines {
            ask(client, parse(line)?)?;
        }
        Ok(())
    }

    fn read(
        &mut self,
        client: &mut Client<L>,
        measurement: &Measurement,
    ) -> Result<f64, BenchError> {
        let request = parse(&format!("meter {}", measurement.point))?;
        let answer = ask(client, request)?;
        let value = answer.split(' ').next().and_then(|word| word.parse().ok());
        value.ok_or_else(|| {
            BenchError::Failed(format!("the surroundings answer '{request}' with '{answer}'"))
        })
    }

    fn turn(
        &mut self,
        client: &mut Client<L>,
        (from_ohm, to_ohm): (f64, f64),
        tripped: &mut dyn FnMut(&mut Client<L>) -> Result<bool, BenchError>,
    ) -> Result<Option<f64>, BenchError> {
        let factor = if to_ohm < from_ohm { 1.0 - TURN_STEP } else { 1.0 + TURN_STEP };
        let mut ohm = from_ohm;
        while (ohm - to_ohm) * (from_ohm - to_ohm) > 0.0 {
            let part = Part::Resistor(ThermistorId::Check, ohm);
            ask(client, BenchRequest::Fit(part))?;
            let waited = client.wait(Duration::from_millis(TURN_MS));
            waited.map_err(|error| BenchError::Failed(error.to_string()))?;
            if tripped(client)? {
                return Ok(Some(ohm));
            }
            ohm *= factor;
        }
        Ok(None)
    }

    fn record(&mut self, record: &Record) {
        (self.watch)(&record.to_string());
    }
}

impl<L: AskSurroundings + Link> Surroundings<L> for EmulatedBench<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        let request = SurroundingsRequest::Reference(thermistor);
        let answer = client.link().ask_surroundings(&request);
        let answer = answer.map_err(SurroundingsError::Failed)?;
        answer.parse().map_err(|_| {
            SurroundingsError::Failed(format!(
                "the surroundings answer '{request}' with '{answer}'"
            ))
        })
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        let request = SurroundingsRequest::Bath(thermistor, bath_c);
        let answer = client.link().ask_surroundings(&request);
        answer.map(drop).map_err(SurroundingsError::Failed)
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<L>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        let request = SurroundingsRequest::Phantom(place);
        let answer = client.link().ask_surroundings(&request);
        answer.map(drop).map_err(SurroundingsError::Failed)
    }

    fn reads_again(&mut self, _why: &str) -> bool {
        false
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        (self.watch)(&event.to_string());
    }
}

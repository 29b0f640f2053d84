//! The bench of a person at a terminal.

use std::time::Duration;

use thermal_client::client::Client;
use thermal_client::commissioning::{
    CommissioningEvent, PhantomPlace, Surroundings, SurroundingsError,
};
use thermal_client::link::Link;
use thermal_device::safety::ThermistorId;

use super::bench::{Bench, BenchError, Measurement};
use super::check::{ManualStep, Stage};
use super::report::Record;
use super::unit::Unit;
use crate::bench_operator::BenchOperator;

/// Interval at which the device is looked at while the person turns a resistor.
const TURN_LOOK: Duration = Duration::from_millis(50);
/// Readings of the same value that count as the same, as a fraction: two readings of one meter.
const SAME: f64 = 0.02;

/// A person who is told what to do, and types what instruments show. Every answer may be `?`, which explains, or `abort`,
/// which ends the procedure with the bridge off.
pub struct Terminal<'a> {
    person: BenchOperator<'a>,
}

impl<'a> Terminal<'a> {
    /// The bench of this person.
    pub const fn new(person: BenchOperator<'a>) -> Self {
        Self { person }
    }

    /// Waits until the person has done something; `why` is the answer to `?`.
    fn confirm<L: Link>(
        &mut self,
        client: &mut Client<L>,
        what: &str,
        why: &str,
    ) -> Result<(), BenchError> {
        self.person.tell(&format!("\n{what}\n"));
        loop {
            let typed = self.ask(client, "  Enter when done, `?`, or `abort`: ")?;
            match typed.as_str() {
                "" => return Ok(()),
                "?" => self.person.tell(&format!("  {why}\n")),
                other => self.person.tell(&format!(
                    "  '{other}' is not expected here: press Enter alone when it is done\n"
                )),
            }
        }
    }

    fn ask<L: Link>(
        &mut self,
        client: &mut Client<L>,
        question: &str,
    ) -> Result<String, BenchError> {
        self.person.ask(client, question).map_err(bench_error)
    }

    /// A value that the person types. One that is not allowed must be typed twice, because it may be a typing error.
    fn value<L: Link>(
        &mut self,
        client: &mut Client<L>,
        unit: Unit,
        (least, most): (f64, f64),
        explanation: &str,
    ) -> Result<f64, BenchError> {
        let mut doubted: Option<f64> = None;
        let question = format!("  It shows, in {unit}: ");
        loop {
            let typed = self.ask(client, &question)?;
            if typed == "?" {
                self.person.tell(&format!("  {explanation}\n"));
                continue;
            }
            match unit.parse(&typed) {
                Ok(value) if (least..=most).contains(&value) => return Ok(value),
                Ok(value) if doubted.is_some_and(|before| is_same(before, value)) => {
                    return Ok(value);
                }
                Ok(value) => {
                    doubted = Some(value);
                    self.person.tell(&format!(
                        "  {} is not expected. If the instrument really shows it, type it again; if not, the right value\n",
                        unit.text(value)
                    ));
                }
                Err(error) => self.person.tell(&format!("  {error}\n")),
            }
        }
    }
}

fn is_same(before: f64, value: f64) -> bool {
    before == value || (before - value).abs() <= SAME * before.abs()
}

fn bench_error(error: SurroundingsError) -> BenchError {
    match error {
        SurroundingsError::Interrupted => BenchError::Aborted,
        SurroundingsError::Failed(why) => BenchError::Failed(why),
    }
}

fn range_text((least, most): (f64, f64), unit: Unit) -> String {
    super::check::Expected::Range(least, most, unit).to_string()
}

impl<L: Link> Bench<L> for Terminal<'_> {
    fn begin(&mut self, stage: &Stage) {
        let Stage { name, title, .. } = stage;
        self.person.tell(&format!("\n== {title} ({name}) ==\n"));
    }

    fn act(&mut self, client: &mut Client<L>, manual: &ManualStep) -> Result<(), BenchError> {
        let why = "the next checks need it; wiring and parts are in hardware/wiring.md and hardware/schematic.svg";
        self.confirm(client, manual.say, why)
    }

    fn read(
        &mut self,
        client: &mut Client<L>,
        measurement: &Measurement,
    ) -> Result<f64, BenchError> {
        let Measurement { what, how, unit, allowed, basis, .. } = *measurement;
        self.person.tell(&format!("\n{what}: {how}.\n"));
        let expected = range_text(allowed, unit);
        self.value(client, unit, allowed, &format!("expected: {expected} ({basis})"))
    }

    fn turn(
        &mut self,
        client: &mut Client<L>,
        (from_ohm, to_ohm): (f64, f64),
        tripped: &mut dyn FnMut(&mut Client<L>) -> Result<bool, BenchError>,
    ) -> Result<Option<f64>, BenchError> {
        let (from, to) = (Unit::Ohm.text(from_ohm), Unit::Ohm.text(to_ohm));
        self.confirm(
            client,
            &format!("Set the resistor to {from}."),
            "the comparator has not tripped there yet",
        )?;
        self.person.tell(&format!(
            "Turn it slowly towards {to} until I say stop. If you reach {to} before, type `end`.\n"
        ));
        loop {
            if tripped(client)? {
                break;
            }
            match self.person.typed().map_err(bench_error)?.as_deref() {
                Some("end") => return Ok(None),
                Some(other) => self.person.tell(&format!(
                    "  '{other}' is not expected here: turn on, or type `end` at {to}, or `abort`\n"
                )),
                None => {
                    client.wait(TURN_LOOK).map_err(|error| BenchError::Failed(error.to_string()))?
                }
            }
        }
        self.person.tell(
            "\x07Stop: the comparator has tripped. Disconnect the resistor and measure it.\n",
        );
        let allowed = (from_ohm.min(to_ohm), from_ohm.max(to_ohm));
        let expected = range_text(allowed, Unit::Ohm);
        let at_ohm =
            self.value(client, Unit::Ohm, allowed, &format!("somewhere on its way: {expected}"))?;
        Ok(Some(at_ohm))
    }

    fn record(&mut self, record: &Record) {
        self.person.tell(&format!("{record}\n"));
    }
}

impl<L: Link> Surroundings<L> for Terminal<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        self.person.reference_c(client, thermistor)
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        self.person.put_into_bath(client, thermistor, bath_c)
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<L>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        self.person.move_phantom(client, place)
    }

    fn reads_again(&mut self, why: &str) -> bool {
        Surroundings::<L>::reads_again(&mut self.person, why)
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        Surroundings::<L>::notice(&mut self.person, event);
    }
}

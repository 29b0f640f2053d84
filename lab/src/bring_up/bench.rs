//! The bench: hands and instruments.

use thermal_client::client::Client;
use thermal_client::commissioning::Surroundings;

use super::check::{ManualStep, Stage};
use super::report::Record;
use super::unit::Unit;

/// Why the bench does not do what the procedure needs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BenchError {
    /// The person has ended the procedure.
    #[error("ended by the person")]
    Aborted,
    /// It cannot be done, for this reason.
    #[error("{0}")]
    Failed(String),
}

/// A reading that the procedure asks for.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// What is measured.
    pub what: &'static str,
    /// Name of the point on the line to the surroundings.
    pub point: &'static str,
    /// What to do with the instrument.
    pub how: &'static str,
    /// Unit of the value.
    pub unit: Unit,
    /// Limits that are allowed. A person who types a value outside of them is asked again, as it may be a typing error.
    pub allowed: (f64, f64),
    /// Where the limits come from.
    pub basis: &'static str,
}

/// Hands and instruments at the board: those of a person, or of the surroundings of an emulated board. What
/// commissioning needs of them is in [`Surroundings`].
pub trait Bench<L>: Surroundings<L> {
    /// Is told that a stage begins.
    fn begin(&mut self, stage: &Stage);

    /// Does something by hand.
    ///
    /// # Errors
    /// It cannot be done, or the person has ended the procedure.
    fn act(&mut self, client: &mut Client<L>, manual: &ManualStep) -> Result<(), BenchError>;

    /// Reads an instrument.
    ///
    /// # Errors
    /// There is no reading, or the person has ended the procedure.
    fn read(
        &mut self,
        client: &mut Client<L>,
        measurement: &Measurement,
    ) -> Result<f64, BenchError>;

    /// Turns the resistor in place of the second display thermistor from one value, ohm, to another, until `tripped` says
    /// so; returns its value there, or `None` at the end.
    ///
    /// # Errors
    /// It cannot be done, `tripped` has failed, or the person has ended the procedure.
    fn turn(
        &mut self,
        client: &mut Client<L>,
        ohm: (f64, f64),
        tripped: &mut dyn FnMut(&mut Client<L>) -> Result<bool, BenchError>,
    ) -> Result<Option<f64>, BenchError>;

    /// Is told a result.
    fn record(&mut self, record: &Record);
}

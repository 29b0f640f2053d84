//! What surrounds the device while it is commissioned.

use thermal_device::safety::ThermistorId;

use super::{CommissioningEvent, PhantomPlace};
use crate::client::Client;

/// Reference thermometer, baths and coolant: those of a simulated operator, or of a person who is told what to do and asked
/// for what the thermometer shows.
pub trait Surroundings<L> {
    /// What the reference thermometer shows at a thermistor, °C; the display's two have it in common.
    ///
    /// # Errors
    /// There is no reading, or the person has ended the procedure.
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError>;

    /// Puts the probe of the reference thermometer on the display, or takes it off: its weight would count as a finger when the
    /// tile is identified. A simulated one has no weight.
    ///
    /// # Errors
    /// The person has ended the procedure.
    fn put_probe_on_display(
        &mut self,
        _client: &mut Client<L>,
        _on: bool,
    ) -> Result<(), SurroundingsError> {
        Ok(())
    }

    /// Puts a thermistor into a bath of about this temperature, °C, and the reference thermometer beside it; the sink's
    /// instead gets a coolant of this temperature.
    ///
    /// # Errors
    /// It cannot be done, or the person has ended the procedure.
    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError>;

    /// Moves the phantom of the heat-flux sensor.
    ///
    /// # Errors
    /// There is none, or the person has ended the procedure.
    fn move_phantom(
        &mut self,
        _client: &mut Client<L>,
        _place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        Err(SurroundingsError::Failed("no phantom is here".into()))
    }

    /// Whether the thermometer is read again after the device refused a point for this reason: a person may have mistyped. If
    /// not, a point in a bath is left out.
    fn reads_again(&mut self, why: &str) -> bool;

    /// Is told what happens.
    fn notice(&mut self, event: &CommissioningEvent);
}

/// Why the surroundings do not do what the procedure needs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurroundingsError {
    /// It cannot be done, for this reason.
    #[error("{0}")]
    Failed(String),
    /// The person has ended the procedure.
    #[error("interrupted")]
    Interrupted,
}

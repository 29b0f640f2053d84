//! The simulated operator commissions or restores the device of an engine.

use std::time::Duration;

use thermal_client::client::{Client, IdentifiedTile};
use thermal_client::commissioning::{
    self, CommissionError, CommissioningEvent, CommissioningRecord,
};

use super::CommissioningSetup;
use super::surroundings::{SimulatedOperator, SimulatedSurroundings};
use crate::engine::Engine;
use crate::simulated_link::SimulatedLink;

/// Time after power-up before the first line, when a device is only restored.
const START: Duration = Duration::from_millis(10);

/// Commissions a device, which was just switched on in its [place of use](CommissioningSetup::in_use), by the one
/// [procedure](commissioning::commission). `watch` is called for each event.
///
/// # Errors
/// The device cannot be commissioned.
pub fn commission<E: Engine>(
    setup: &CommissioningSetup,
    engine: &mut E,
    watch: &mut dyn FnMut(&CommissioningEvent),
) -> Result<CommissioningRecord, CommissionError> {
    let mut operator = SimulatedOperator { surroundings: SimulatedSurroundings::new(setup), watch };
    let mut client = Client::new(SimulatedLink::new(engine));
    commissioning::commission(&mut client, None, &mut operator)
}

/// Restores a device that was just switched on from lines of settings, and returns the tile that it then reports.
///
/// # Errors
/// The device refuses a line, or reports other settings afterwards.
pub fn restore<E: Engine>(
    engine: &mut E,
    settings: &[String],
) -> Result<IdentifiedTile, CommissionError> {
    let mut client = Client::new(SimulatedLink::new(engine));
    client.wait(START)?;
    commissioning::restore(&mut client, None, settings)
}

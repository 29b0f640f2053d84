//! Commissioning of a device: calibration of its sensors with a reference thermometer, identification of its tile, and
//! storage of its settings. The one procedure of the person at a bench and of the simulated operator.

mod bench_line;
mod flux;
mod procedure;
mod record;
mod surroundings;
mod surroundings_line;

use crate::client::ClientError;
use crate::link::LinkError;

pub use bench_line::{BenchRequest, Button, MeterPoint, Part, Removal};
pub use flux::{FluxCalibration, FluxCalibrationError, PhantomPlace, calibrate_flux};
pub use procedure::{
    arm, clear_calibration, commission, commission_flux_sensor, restore, settings,
};
pub use record::{CalibrationPoint, CommissioningEvent, CommissioningRecord};
pub use surroundings::{Surroundings, SurroundingsError};
pub use surroundings_line::SurroundingsRequest;

/// Why a device cannot be commissioned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommissionError {
    /// A command has no reply.
    #[error("commissioning: {0}")]
    Client(#[from] ClientError),
    /// Reference thermometer or baths do not work, or the person has ended the procedure.
    #[error("commissioning: {0}")]
    Surroundings(#[from] SurroundingsError),
    /// The heat-flux sensor is not calibrated.
    #[error("heat-flux sensor: {0}")]
    Flux(#[from] FluxCalibrationError),
    /// The device does not report a setting that it accepted.
    #[error("commissioning: the device took '{0}', but has other settings")]
    NotRestored(String),
    /// The device did not arm.
    #[error("commissioning: after 'arm' the state is {state}, fault {fault}")]
    NotArmed {
        /// Word of the state.
        state: &'static str,
        /// Word of the fault, or `-`.
        fault: &'static str,
    },
    /// The device took too long.
    #[error("commissioning: '{0}' takes too long")]
    TooLong(&'static str),
    /// The display reached a steady state at too few temperatures.
    #[error(
        "commissioning: the {sensor} thermistor was calibrated at {points} temperatures; needed are {needed} (refused last: {why})"
    )]
    FewPoints {
        /// The word of the thermistor.
        sensor: &'static str,
        /// Points that were accepted.
        points: usize,
        /// Required number of points.
        needed: usize,
        /// Why the last one was not accepted.
        why: String,
    },
}

impl From<LinkError> for CommissionError {
    fn from(error: LinkError) -> Self {
        Self::Client(error.into())
    }
}

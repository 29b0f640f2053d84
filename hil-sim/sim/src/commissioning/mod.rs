//! Commissioning of a device by a simulated operator: calibration of its sensors with a reference thermometer,
//! identification of its tile, and storage of its settings as lines.
//!
//! The device has the parts and the converter of a scene's device, with other noise.

mod bench;
mod frequency_response;
mod operator;
mod record;
mod setup;

use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

use thermal_plant::{ConfigError, Params};

use crate::engine::NativeEngine;
use crate::scene::Scene;

pub use bench::CommissioningBench;
pub use frequency_response::FrequencyResponse;
pub use operator::{commission, restore};
pub use record::{CalibrationPoint, CommissioningEvent, CommissioningRecord, IdentifiedTile};
pub use setup::CommissioningSetup;

/// Why a device cannot be commissioned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommissionError {
    /// The plant cannot be built.
    #[error("commissioning: {0}")]
    Plant(#[from] ConfigError),
    /// The engine stopped.
    #[error("commissioning: {0}")]
    Stop(String),
    /// The device refused a line.
    #[error("commissioning: the device answers '{line}' with '{answer}'")]
    Refused {
        /// The line.
        line: String,
        /// The answer.
        answer: String,
    },
    /// The device did not answer a line.
    #[error("commissioning: the device does not answer '{0}'")]
    Silent(String),
    /// The device does not report a setting that it accepted.
    #[error("commissioning: the device took '{0}', but has other settings")]
    NotRestored(String),
    /// The display reached a steady state at too few temperatures.
    #[error(
        "commissioning: the display came to rest at {points} temperatures; needed are {needed} (the last: {why})"
    )]
    FewPoints {
        /// Points that were accepted.
        points: usize,
        /// Required number of points.
        needed: usize,
        /// Why the last one was not accepted.
        why: String,
    },
}

/// Lines of settings, or why commissioning failed; computed once.
type SharedSettings = Arc<OnceLock<Result<Vec<String>, CommissionError>>>;

/// The settings of a scene's device as lines; none if it is not commissioned. Computed by the native engine, once per
/// process for each device.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_scene(scene: &Scene) -> Result<Vec<String>, CommissionError> {
    if !scene.commissioned {
        return Ok(Vec::new());
    }
    settings_for_device(&scene.params, scene.room_c, scene.seed)
}

/// The settings of a device with these parameters and this seed of its converter, in a room, deg C.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_device(
    params: &Params,
    room_c: f64,
    seed: u64,
) -> Result<Vec<String>, CommissionError> {
    static KNOWN: LazyLock<Mutex<HashMap<String, SharedSettings>>> = LazyLock::new(Mutex::default);
    let plants = CommissioningSetup::new(params, room_c, seed);
    let lines = {
        // A thread that panicked has at most left an entry without lines.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(plants.key()).or_default())
    };
    let found = || -> Result<Vec<String>, CommissionError> {
        let mut engine = NativeEngine::new(plants.in_use()?);
        Ok(commission(&plants, &mut engine, &mut |_| ())?.settings)
    };
    lines.get_or_init(found).clone()
}

impl From<Infallible> for CommissionError {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}

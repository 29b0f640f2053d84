//! The operator who commissions a device: holds a reference thermometer to its sensors, has it find out about its tile,
//! and keeps its settings as lines.
//!
//! The device is the one of a scene: same parts, same converter; the noise is another.

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
        /// What it was told.
        line: String,
        /// What it said.
        answer: String,
    },
    /// The device did not answer a line.
    #[error("commissioning: the device does not answer '{0}'")]
    Silent(String),
    /// The device does not have a setting that it was given.
    #[error("commissioning: the device took '{0}', but has other settings")]
    NotRestored(String),
    /// The display could not be held at enough temperatures.
    #[error(
        "commissioning: the display came to rest at {points} temperatures; needed are {needed} (the last: {why})"
    )]
    FewPoints {
        /// Points that were taken.
        points: usize,
        /// Least number that must be.
        needed: usize,
        /// Why the last one was not.
        why: String,
    },
}

/// Lines of settings, or why there are none.
type Lines = Arc<OnceLock<Result<Vec<String>, CommissionError>>>;

/// The settings of the device of a scene as lines; none if it is not commissioned. Found natively, once for each device
/// of the process.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_scene(scene: &Scene) -> Result<Vec<String>, CommissionError> {
    if !scene.commissioned {
        return Ok(Vec::new());
    }
    settings_for_device(&scene.params, scene.room_c, scene.seed)
}

/// The same for a device of these parts and this seed of its converter, in a room, deg C.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_device(
    params: &Params,
    room_c: f64,
    seed: u64,
) -> Result<Vec<String>, CommissionError> {
    static KNOWN: LazyLock<Mutex<HashMap<String, Lines>>> = LazyLock::new(Mutex::default);
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

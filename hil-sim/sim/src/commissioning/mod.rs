//! Commissioning of a simulated device by a simulated operator, who follows the
//! [procedure](thermal_client::commissioning::commission) of the person at a bench.
//!
//! The device has the parts and the converter of a scene's device, with other noise.

mod enrolment;
mod frequency_response;
mod operator;
mod setup;
mod shipped;
mod surroundings;

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

use thermal_client::client::SessionRequest;
use thermal_client::commissioning::SurroundingsError;
use thermal_plant::parameters::{Tolerance, relative};
use thermal_plant::{ConfigError, Params};
use thermal_settings::{DisplaySurface, FluxSensor};

use crate::engine::NativeEngine;
use crate::scene::Scene;

pub use thermal_client::client::IdentifiedTile;
pub use thermal_client::commissioning::{
    CalibrationPoint, CommissionError, CommissioningEvent, CommissioningRecord,
};

pub use enrolment::with_person;
pub use frequency_response::FrequencyResponse;
pub use operator::{commission, restore};
pub use setup::{CommissioningSetup, SimulatedPhantom};
pub use shipped::shipped_devices;
pub use surroundings::{SimulatedOperator, SimulatedSurroundings, SurroundingsAction};

/// Lines of settings, or why commissioning failed; computed once.
type SharedSettings = Arc<OnceLock<Result<Vec<String>, CommissionError>>>;

/// Error of the conductivity, roughness and slope that the operator measures of a display: a standard deviation of 5 %.
const SURFACE_MEASUREMENT: Tolerance = relative(0.1).normal();

/// The settings of a scene's device as lines: those of commissioning, none if it is not commissioned, its heat-flux sensor
/// if it is fitted, and the surface of its display if it was measured.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_scene(scene: &Scene) -> Result<Vec<String>, CommissionError> {
    let mut lines = if scene.commissioned {
        settings_for_device(&scene.params, scene.room_c, scene.seed)?
    } else {
        Vec::new()
    };
    lines.extend(flux_sensor_line(&scene.params));
    if scene.measured_surface {
        lines.push(SessionRequest::display_surface(display_surface(scene)).to_string());
    }
    Ok(lines)
}

/// The line that sets a calibrated heat-flux sensor, if the plant has one. Its errors in the plant are those that are left after
/// its gain was calibrated and its zero taken.
pub fn flux_sensor_line(params: &Params) -> Option<String> {
    let counts_per_w_m2 = params.flux.as_ref()?.counts_per_w_m2;
    let sensor = FluxSensor { counts_per_w_m2, ..FluxSensor::DESIGNED };
    Some(SessionRequest::flux_sensor(Some(sensor)).to_string())
}

/// The surface that the device of a scene takes for that of its display: the measured one, if it was measured.
pub fn display_surface(scene: &Scene) -> DisplaySurface {
    if !scene.measured_surface {
        return DisplaySurface::NOMINAL;
    }
    let display = &scene.params.display;
    let values = [
        ("conductivity", display.conductivity_w_mk),
        ("roughness", display.roughness_um),
        ("slope", display.slope_rad),
    ];
    let measured = values.map(|(name, value)| {
        SURFACE_MEASUREMENT.draw(value, scene.seed, &format!("measured.display.{name}"))
    });
    DisplaySurface::from_array_rounded(measured)
}

/// The settings of a device with these parameters and this seed of its converter, in a room, deg C: those that are kept of
/// it, or those that commissioning finds, once per process for each device.
///
/// # Errors
/// The device cannot be commissioned.
pub fn settings_for_device(
    params: &Params,
    room_c: f64,
    seed: u64,
) -> Result<Vec<String>, CommissionError> {
    static KNOWN: LazyLock<Mutex<HashMap<String, SharedSettings>>> = LazyLock::new(|| {
        let kept =
            shipped_devices().map(|(setup, lines)| (setup.key(), Arc::new(Ok(lines).into())));
        Mutex::new(kept.collect())
    });
    let plants = CommissioningSetup::new(params, room_c, seed);
    let lines = {
        // A thread that panicked has at most left an entry without lines.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(plants.key()).or_default())
    };
    let found = || -> Result<Vec<String>, CommissionError> {
        let mut engine = NativeEngine::new(plants.in_use().map_err(no_plant)?);
        Ok(commission(&plants, &mut engine, &mut |_| ())?.settings)
    };
    lines.get_or_init(found).clone()
}

fn no_plant(error: ConfigError) -> CommissionError {
    SurroundingsError::Failed(error.to_string()).into()
}

//! What the device streams.

use contact_model::fixed_point::{Celsius, Force};

use crate::StateName;
use crate::drive::Current;

/// One tick, as it is reported to the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Ticks since reset.
    pub tick: u32,
    /// State of the station at the end of the tick.
    pub state: StateName,
    /// Set-point, °C, if the bridge is driven.
    pub setpoint: Option<Celsius>,
    /// The set-point was limited to the safe range.
    pub limited: bool,
    /// Reading of the display thermistor, °C; `None` if it is invalid.
    pub display: Option<Celsius>,
    /// Reading of the sink, °C; `None` if it is invalid.
    pub sink: Option<Celsius>,
    /// Reading of the skin, °C; `None` if it is invalid.
    pub skin: Option<Celsius>,
    /// Reading of the room, °C; `None` if it is invalid.
    pub room: Option<Celsius>,
    /// Force, N; `None` if the sensor is faulty.
    pub force: Option<Force>,
    /// Demanded current, A; positive cools.
    pub demand: Current,
    /// Magnitude of the measured current, A.
    pub current: Current,
    /// Evaluations of `erfcx` since reset.
    pub evaluations: u32,
}

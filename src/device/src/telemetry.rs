//! What the device streams.

use contact_model::fixed_point::{Celsius, Force};

use crate::StateName;
use crate::drive::Current;

/// What the host is told of one control tick of one finger, while telemetry streams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Number of the tick, of 1 ms since the last reset; wraps after 49 days.
    pub tick: u32,
    /// State of the station after the tick, with the fault if it is tripped.
    pub state: StateName,
    /// Set-point that the display follows, °C; `None` while the bridge is off and during the self-test.
    pub setpoint: Option<Celsius>,
    /// Whether the model's set-point was outside of 15 to 42 °C and had to be clamped to that range.
    pub limited: bool,
    /// Reading of the first display thermistor, °C; `None` if the thermistor is open or shorted.
    pub display: Option<Celsius>,
    /// Reading of the sink's thermistor, °C; `None` if the thermistor is open or shorted.
    pub sink: Option<Celsius>,
    /// Reading of the skin's thermistor, °C, which sees the room if no finger is there; `None` if it is open or
    /// shorted.
    pub skin: Option<Celsius>,
    /// Reading of the room's thermistor, °C; `None` if the thermistor is open or shorted.
    pub room: Option<Celsius>,
    /// Force of the finger on the display, N; `None` if the force sensor's wire is broken or shorted.
    pub force: Option<Force>,
    /// Current that this tick demands of the bridge, A, -6 to 6; positive cools; zero if the bridge is off.
    pub demand: Current,
    /// Magnitude of the module current measured in this tick, A; responds to the demand of the tick before.
    pub current: Current,
    /// Evaluations of the function `erfcx` for set-points since the last reset, a measure of the load; wraps at 2^32.
    pub evaluations: u32,
}

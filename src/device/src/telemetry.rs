//! What the device streams.

use contact_model::fixed_point::{Celsius, Force};

use crate::StateName;
use crate::drive::Current;

/// One tick, as it is reported to the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Ticks since reset.
    pub tick: u32,
    /// State of the station.
    pub state: StateName,
    /// Set-point, °C, if the bridge is driven.
    pub setpoint: Option<Celsius>,
    /// The set-point was limited to the safe range.
    pub limited: bool,
    /// Display thermistor, °C.
    pub display: Option<Celsius>,
    /// Sink thermistor, °C.
    pub sink: Option<Celsius>,
    /// Skin thermistor, °C.
    pub skin: Option<Celsius>,
    /// Room thermistor, °C.
    pub room: Option<Celsius>,
    /// Force, N.
    pub force: Option<Force>,
    /// Demanded current, A; positive cools.
    pub demand: Current,
    /// Magnitude of the measured current, A.
    pub current: Current,
    /// Evaluations of `erfcx` since reset.
    pub evaluations: u32,
}

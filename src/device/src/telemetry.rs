//! What the device streams.

use contact_model::fixed_point::{Celsius, Force};

use crate::drive::Current;
use crate::safety::State;

/// One tick; `Display` writes the telemetry line without its end, at most 128 bytes.
///
/// `T tick state setpoint_c display_c sink_c skin_c room_c force_n demand_a current_a evaluations remark`,
/// with `-` for what is not known; the remark is the fault that tripped, `limited` or `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Ticks since reset.
    pub tick: u32,
    /// State.
    pub state: State,
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
    /// Current asked for, A; positive cools.
    pub demand: Current,
    /// Magnitude of the measured current, A.
    pub current: Current,
    /// Evaluations of `erfcx` since reset.
    pub evaluations: u32,
}

impl Telemetry {
    /// Before the first tick.
    #[must_use]
    pub const fn before_first_tick() -> Self {
        Self {
            tick: 0,
            state: State::Off,
            setpoint: None,
            limited: false,
            display: None,
            sink: None,
            skin: None,
            room: None,
            force: None,
            demand: Current::ZERO,
            current: Current::ZERO,
            evaluations: 0,
        }
    }
}

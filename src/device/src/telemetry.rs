//! Telemetry: what a station reports of a control tick to the host.

use contact_model::fixed_point::{Celsius, Force};

use crate::StateName;
use crate::drive::Current;

/// Fields of a telemetry line that the host may leave out, by their places in a line, which `thermal-wire` declares. The tick,
/// the state and the remark, which names a fault, are always there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TelemetryFields(u16);

impl TelemetryFields {
    /// No field.
    pub const NONE: Self = Self(0);

    /// The first fields of a line, so many, up to 15.
    pub const fn of_first(count: usize) -> Self {
        Self((1 << count) - 1)
    }

    /// The set with the field at this place, 0 to 15, too.
    #[must_use]
    pub const fn with(self, place: usize) -> Self {
        Self(self.0 | 1 << place)
    }

    /// Whether the field at this place is in the set.
    pub const fn contains(self, place: usize) -> bool {
        self.0 & 1 << place != 0
    }

    /// The fields of both sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The set without the fields of another.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether a field is in both sets.
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// What one line of telemetry reports to the host: readings, set-point and current of one finger in one control tick. What the
/// heat-flux sensor shows is asked for when the line is written ([`crate::command::Command::Flux`]): in here it would cost every
/// tick 40 cycles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Number of the tick: ticks of 1 ms since the last reset; wraps after 49 days.
    pub tick: u32,
    /// State of the station after the tick; in the state tripped with the fault.
    pub state: StateName,
    /// Set-point of the tick, °C. `None` if the tick began in off, self-test, ready or tripped, or found a fault: no
    /// set-point is followed then.
    pub setpoint: Option<Celsius>,
    /// Whether the set-point of the tick is not the one that was asked for, because that is outside of its range; or, on a tile
    /// that was never identified, moves too fast.
    pub limited: bool,
    /// Whether the tile was identified or set; if not, the set-point is limited to 20 to 38 °C and 1 K/s.
    pub is_tuned: bool,
    /// Reading of the first display thermistor, °C, which the control laws use; `None` if the thermistor is open or
    /// shorted.
    pub display: Option<Celsius>,
    /// Reading of the second display thermistor, °C, which checks the first one: a difference that grows shows a calibration that
    /// is no longer right before it trips. `None` if the thermistor is open or shorted.
    pub check: Option<Celsius>,
    /// Reading of the heat sink's thermistor, °C; `None` if the thermistor is open or shorted.
    pub sink: Option<Celsius>,
    /// Reading of the thermistor on the skin beside the contact, °C; the room's temperature if no finger is there.
    /// `None` if the thermistor is open or shorted.
    pub skin: Option<Celsius>,
    /// Reading of the thermistor in the room's air, °C; `None` if the thermistor is open or shorted.
    pub room: Option<Celsius>,
    /// Force of the finger on the display, N, 0 or more; `None` if the force sensor's wire is broken or shorted.
    pub force: Option<Force>,
    /// Current that this tick demands of the bridge, A, -6 to 6; positive cools the display; zero if the bridge is off.
    pub demand: Current,
    /// Magnitude of the module current that the current mirror shows in this tick, A. It responds to the current that
    /// the tick before has demanded.
    pub current: Current,
    /// Evaluations of the function `erfcx` for set-points since the last reset, as a measure of the processor's load;
    /// wraps at 2^32.
    pub evaluations: u32,
    /// The fields that the host has chosen.
    pub fields: TelemetryFields,
}

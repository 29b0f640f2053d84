//! What the device streams.

use core::fmt;

use contact_model::fixed_point::{Celsius, Force};

use super::text::Text;
use crate::drive::Current;
use crate::guard::State;

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

impl fmt::Display for Telemetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = Text::new();
        line.word("T ");
        line.count(self.tick);
        line.word(" ");
        line.word(self.state.name());
        line.word(" ");
        line.celsius::<5>(self.setpoint);
        line.word(" ");
        line.celsius::<4>(self.display);
        for temperature in [self.sink, self.skin, self.room] {
            line.word(" ");
            line.celsius::<2>(temperature);
        }
        line.word(" ");
        line.force(self.force);
        for current in [self.demand, self.current] {
            line.word(" ");
            line.current(current);
        }
        line.word(" ");
        line.count(self.evaluations);
        line.word(" ");
        line.word(match self.state.fault() {
            Some(fault) => fault.name(),
            None if self.limited => "limited",
            None => "-",
        });
        line.fmt(f)
    }
}

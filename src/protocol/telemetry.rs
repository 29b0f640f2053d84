//! What the device streams.

use core::fmt;

use contact_model::fixed_point::{Celsius, Force};

use super::decimal::{CELSIUS, CURRENT, Count, Decimal, FORCE};
use crate::drive::Current;
use crate::station::State;

/// One tick; `Display` writes the telemetry line without its end, at most 95 bytes.
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
        f.write_str("T ")?;
        Count(self.tick).fmt(f)?;
        f.write_str(" ")?;
        f.write_str(self.state.name())?;
        f.write_str(" ")?;
        Decimal::<CELSIUS, 5>::from(self.setpoint).fmt(f)?;
        f.write_str(" ")?;
        Decimal::<CELSIUS, 4>::from(self.display).fmt(f)?;
        for temperature in [self.sink, self.skin, self.room] {
            f.write_str(" ")?;
            Decimal::<CELSIUS, 2>::from(temperature).fmt(f)?;
        }
        f.write_str(" ")?;
        Decimal::<FORCE, 3>::force(self.force).fmt(f)?;
        for current in [self.demand, self.current] {
            f.write_str(" ")?;
            Decimal::<CURRENT, 3>::current(current).fmt(f)?;
        }
        f.write_str(" ")?;
        Count(self.evaluations).fmt(f)?;
        f.write_str(" ")?;
        f.write_str(match self.state.fault() {
            Some(fault) => fault.name(),
            None if self.limited => "limited",
            None => "-",
        })
    }
}

//! Answers to commands that were executed.

use core::fmt;

use contact_model::fixed_point::Celsius;

use super::decimal::{CELSIUS, Decimal};
use crate::render::Mode;
use crate::station::State;
use crate::{SCANS_PER_SECOND, TICK_HZ};

/// An answer; `Display` writes the line without its end, at most 128 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// It is done.
    Done,
    /// Answer to `id`.
    Identity,
    /// Answer to `state`.
    Status(Status),
}

/// What the device is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State and, if tripped, why.
    pub state: State,
    /// Chosen material.
    pub material: Option<&'static str>,
    /// Object temperature; that of the room if none was given.
    pub object: Option<Celsius>,
    /// Model.
    pub mode: Mode,
    /// Set-point.
    pub setpoint: Option<Celsius>,
    /// The set-point was limited to the safe range.
    pub limited: bool,
    /// Display temperature.
    pub display: Option<Celsius>,
    /// Ticks since reset.
    pub ticks: u32,
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done => f.write_str("ok"),
            Self::Identity => write!(
                f,
                "ok {} {} fingers=1 tick_hz={TICK_HZ} scan_hz={SCANS_PER_SECOND}",
                env!("CARGO_PKG_NAME"),
                env!("CARGO_PKG_VERSION"),
            ),
            Self::Status(status) => write!(f, "ok {status}"),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mode = match self.mode {
            Mode::ContactResistance => "contact",
            Mode::SemiInfinite => "semi-infinite",
        };
        write!(
            f,
            "state={} fault={}",
            self.state.name(),
            self.state.fault().map_or("-", |f| f.name())
        )?;
        write!(f, " material={} object_c=", self.material.unwrap_or("-"))?;
        match self.object {
            Some(_) => write!(f, "{}", Decimal::<CELSIUS, 2>::from(self.object))?,
            None => f.write_str("room")?,
        }
        write!(
            f,
            " mode={mode} setpoint_c={}",
            Decimal::<CELSIUS, 3>::from(self.setpoint)
        )?;
        write!(f, " display_c={}", Decimal::<CELSIUS, 3>::from(self.display))?;
        write!(f, " limited={} ticks={}", u8::from(self.limited), self.ticks)
    }
}

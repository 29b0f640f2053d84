//! Answers to commands that were executed.

use core::fmt;

use contact_model::fixed_point::Celsius;

use super::text::Text;
use crate::control::Law;
use crate::render::Mode;
use crate::station::State;
use crate::{SCANS_PER_SECOND, TICK_HZ};

/// An answer; `Display` writes the line without its end, at most 128 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// It is done.
    Done,
    /// Answer to `id`.
    Identity {
        /// Fingers of the device.
        fingers: u8,
    },
    /// Answer to `state`.
    Status(Status),
    /// Answer to `law`.
    Law(Law),
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
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done => f.write_str("ok"),
            Self::Identity { fingers } => write!(
                f,
                "ok {} {} fingers={fingers} tick_hz={TICK_HZ} scan_hz={SCANS_PER_SECOND}",
                env!("CARGO_PKG_NAME"),
                env!("CARGO_PKG_VERSION"),
            ),
            Self::Status(status) => write!(f, "ok {status}"),
            Self::Law(law) => write!(f, "ok law={}", law.name()),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = Text::new();
        line.word("state=");
        line.word(self.state.name());
        line.word(" fault=");
        line.word(self.state.fault().map_or("-", |fault| fault.name()));
        line.word(" material=");
        line.word(self.material.unwrap_or("-"));
        line.word(" object_c=");
        match self.object {
            Some(_) => line.celsius::<2>(self.object),
            None => line.word("room"),
        }
        line.word(match self.mode {
            Mode::ContactResistance => " mode=contact",
            Mode::SemiInfinite => " mode=semi-infinite",
        });
        line.word(" setpoint_c=");
        line.celsius::<2>(self.setpoint);
        line.word(if self.limited { " limited" } else { "" });
        line.fmt(f)
    }
}

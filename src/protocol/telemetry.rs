//! What the device streams.

use core::fmt;

/// The state of one tick; `Display` writes the telemetry line without its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// Ticks since reset.
    pub tick: u32,
}

impl fmt::Display for Telemetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "T {}", self.tick)
    }
}

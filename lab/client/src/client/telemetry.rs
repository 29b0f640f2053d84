//! Telemetry lines with what the link adds.

use std::time::Duration;

pub use thermal_wire::host::Telemetry;

/// A telemetry line as a client received it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceivedTelemetry {
    /// The finger that it names; `None` from a device with one finger.
    pub finger: Option<u8>,
    /// Its fields.
    pub telemetry: Telemetry,
    /// Time by the link's clock at which it was received.
    pub at: Duration,
    /// Lines that are missing between the last one of this finger and this one, by their ticks.
    pub lost_before: u32,
}

//! Lines that nobody has asked for: telemetry and events.

use core::fmt;

use thermal_device::FingerIndex;
use thermal_device::command::{self, Command, FluxState, WithSourceFinger};
use thermal_device::events::{DeviceEvent, UnsolicitedReport};
use thermal_wire::LineBuffer;
use thermal_wire::telemetry::{FLUX_FIELDS, TelemetryLine};

use crate::command_handler::ExecuteOnStations;

/// A report that nobody has asked for; `Display` writes it as a line to the host, without a line ending: telemetry as
/// [`TelemetryLine`], an event as `E tick us kind`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnsolicitedLine {
    /// Telemetry of a tick.
    Telemetry(TelemetryLine),
    /// An event.
    Event(DeviceEvent),
}

impl UnsolicitedLine {
    /// The line of a report. If it is telemetry with fields of the heat-flux sensor, `execute` asks the finger's station for them
    /// now: they are those of the last tick, also if the report had to wait.
    pub fn of_report<const FINGERS: usize>(
        report: WithSourceFinger<UnsolicitedReport>,
        execute: impl ExecuteOnStations<FINGERS>,
    ) -> WithSourceFinger<Self> {
        let finger = report.finger;
        report.map_content(|report| match report {
            UnsolicitedReport::Event(event) => Self::Event(event),
            UnsolicitedReport::Telemetry(telemetry) => Self::Telemetry(TelemetryLine {
                telemetry,
                flux: if telemetry.fields.intersects(FLUX_FIELDS) {
                    flux_state(finger, execute)
                } else {
                    None
                },
            }),
        })
    }
}

/// Flux and knowledge of a finger, the only one if it has no index.
fn flux_state<const FINGERS: usize>(
    finger: Option<u8>,
    mut execute: impl ExecuteOnStations<FINGERS>,
) -> Option<FluxState> {
    let finger = FingerIndex::new(finger.unwrap_or(0).into())?;
    match execute(Some(finger), Command::Flux).ok()?.content {
        command::Reply::Flux(state) => state,
        _ => None,
    }
}

impl fmt::Display for UnsolicitedLine {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Telemetry(line) => line.fmt(f),
            Self::Event(event) => {
                let mut line = LineBuffer::new();
                line.push_str_if_fits("E ");
                line.push_integer(event.tick);
                line.push_str_if_fits(" ");
                line.push_integer(event.microseconds.into());
                line.push_str_if_fits(" ");
                line.push_str_if_fits(event.kind.name());
                line.fmt(f)
            }
        }
    }
}

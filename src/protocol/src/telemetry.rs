//! The line of streamed telemetry.

use core::fmt;

use thermal_device::Telemetry;
use thermal_device::command::Addressed;

use crate::line_buffer::LineBuffer;

/// Telemetry whose `Display` writes a line without its line ending, at most 128 bytes:
///
/// `T tick state setpoint_c display_c sink_c skin_c room_c force_n demand_a current_a evaluations remark`.
/// An unknown quantity is written as `-`. `evaluations` counts the evaluations of `erfcx` since reset. The remark is the fault
/// that tripped the station, else `limited` if the set-point was limited to 15 to 42 °C, else `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelemetryLine(pub Telemetry);

/// The telemetry line of one finger, with its address.
#[must_use]
pub fn telemetry_line(telemetry: Addressed<Telemetry>) -> Addressed<TelemetryLine> {
    telemetry.map_content(TelemetryLine)
}

impl fmt::Display for TelemetryLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = LineBuffer::new();
        let telemetry = &self.0;
        line.push_str("T ");
        line.push_integer(telemetry.tick);
        line.push_str(" ");
        line.push_str(telemetry.state.name());
        line.push_str(" ");
        line.push_celsius::<5>(telemetry.setpoint);
        line.push_str(" ");
        line.push_celsius::<4>(telemetry.display);
        for temperature in [telemetry.sink, telemetry.skin, telemetry.room] {
            line.push_str(" ");
            line.push_celsius::<2>(temperature);
        }
        line.push_str(" ");
        line.push_force(telemetry.force);
        for current in [telemetry.demand, telemetry.current] {
            line.push_str(" ");
            line.push_current(current);
        }
        line.push_str(" ");
        line.push_integer(telemetry.evaluations);
        line.push_str(" ");
        line.push_str(match telemetry.state.fault() {
            Some(fault) => fault.name(),
            None if telemetry.limited => "limited",
            None => "-",
        });
        line.fmt(f)
    }
}

//! The line of streamed telemetry.

use core::fmt;

use thermal_device::Telemetry;
use thermal_device::command::WithFingerIndex;

use crate::line_buffer::LineBuffer;

/// One finger's telemetry of a tick; `Display` writes it as a line to the host, without a line ending and in at most
/// 128 bytes:
///
/// `T tick state setpoint_c display_c sink_c skin_c room_c force_n demand_a current_a evaluations remark`
///
/// `tick` counts milliseconds since reset. `state` is the state of the finger's station. Temperatures are in °C, the
/// force is in N, the demanded current (positive cools) and the magnitude of the measured current are in A. A quantity
/// whose sensor has failed, and the set-point in a state without one, is written as `-`. `evaluations` counts since
/// reset how often the function `erfcx` was computed for set-points. `remark` is the fault that tripped the station,
/// else `limited` if the set-point was limited to 15 to 42 °C, else `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelemetryLine(pub Telemetry);

/// Wraps one finger's telemetry in a [`TelemetryLine`], whose `Display` writes the line to the host. The address of the
/// finger, which precedes the line on a device with several fingers, does not change.
#[must_use]
pub fn telemetry_line(telemetry: WithFingerIndex<Telemetry>) -> WithFingerIndex<TelemetryLine> {
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

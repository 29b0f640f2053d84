//! The line of streamed telemetry.

use core::fmt;

use thermal_device::Telemetry;
use thermal_device::command::WithSourceFinger;

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
pub fn wrap_as_telemetry_line(
    telemetry: WithSourceFinger<Telemetry>,
) -> WithSourceFinger<TelemetryLine> {
    telemetry.map_content(TelemetryLine)
}

impl fmt::Display for TelemetryLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = LineBuffer::new();
        let telemetry = &self.0;
        line.push_str_if_fits("T ");
        line.push_integer(telemetry.tick);
        line.push_str_if_fits(" ");
        line.push_str_if_fits(telemetry.state.name());
        line.push_str_if_fits(" ");
        line.push_celsius_or_dash::<5>(telemetry.setpoint);
        line.push_str_if_fits(" ");
        line.push_celsius_or_dash::<4>(telemetry.display);
        for temperature in [telemetry.sink, telemetry.skin, telemetry.room] {
            line.push_str_if_fits(" ");
            line.push_celsius_or_dash::<2>(temperature);
        }
        line.push_str_if_fits(" ");
        line.push_force_or_dash(telemetry.force);
        for current in [telemetry.demand, telemetry.current] {
            line.push_str_if_fits(" ");
            line.push_current(current);
        }
        line.push_str_if_fits(" ");
        line.push_integer(telemetry.evaluations);
        line.push_str_if_fits(" ");
        line.push_str_if_fits(match telemetry.state.fault() {
            Some(fault) => fault.name(),
            None if telemetry.limited => "limited",
            None => "-",
        });
        line.fmt(f)
    }
}

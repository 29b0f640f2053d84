//! The line of streamed telemetry.

use core::fmt;

use thermal_device::command::WithSourceFinger;
use thermal_device::events::UnsolicitedReport;
use thermal_device::{Telemetry, TelemetryFields};

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

/// A report that nobody has asked for; `Display` writes it as a line to the host, without a line ending: telemetry as
/// [`TelemetryLine`], an event as `E tick us kind`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsolicitedLine(pub UnsolicitedReport);

impl fmt::Display for UnsolicitedLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            UnsolicitedReport::Telemetry(telemetry) => TelemetryLine(telemetry).fmt(f),
            UnsolicitedReport::Event(event) => {
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

impl fmt::Display for TelemetryLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = LineBuffer::new();
        let telemetry = &self.0;
        line.push_str_if_fits("T ");
        line.push_integer(telemetry.tick);
        line.push_str_if_fits(" ");
        line.push_str_if_fits(telemetry.state.name());
        for index in 0..TelemetryFields::NAMES.len() {
            if !telemetry.fields.contains(index) {
                continue;
            }
            line.push_str_if_fits(" ");
            // In the order of `TelemetryFields::NAMES`.
            match index {
                0 => line.push_celsius_or_dash::<5>(telemetry.setpoint),
                1 => line.push_celsius_or_dash::<4>(telemetry.display),
                2 => line.push_celsius_or_dash::<2>(telemetry.sink),
                3 => line.push_celsius_or_dash::<2>(telemetry.skin),
                4 => line.push_celsius_or_dash::<2>(telemetry.room),
                5 => line.push_force_or_dash(telemetry.force),
                6 => line.push_current(telemetry.demand),
                7 => line.push_current(telemetry.current),
                _ => line.push_integer(telemetry.evaluations),
            }
        }
        line.push_str_if_fits(" ");
        line.push_str_if_fits(match telemetry.state.fault() {
            Some(fault) => fault.name(),
            None if telemetry.limited => "limited",
            None => "-",
        });
        line.fmt(f)
    }
}

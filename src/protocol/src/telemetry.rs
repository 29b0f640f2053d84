//! The telemetry line.

use core::fmt;

use thermal_device::Telemetry;
use thermal_device::command::Addressed;

use crate::text::Text;

/// Writes a telemetry line without its end, at most 128 bytes:
///
/// `T tick state setpoint_c display_c sink_c skin_c room_c force_n demand_a current_a evaluations remark`,
/// with `-` for what is not known; the remark is the fault that tripped, `limited` or `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelemetryLine(pub Telemetry);

/// The line of one finger.
#[must_use]
pub fn telemetry_line(telemetry: Addressed<Telemetry>) -> Addressed<TelemetryLine> {
    telemetry.map(TelemetryLine)
}

impl fmt::Display for TelemetryLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = Text::new();
        line.word("T ");
        line.count(self.0.tick);
        line.word(" ");
        line.word(self.0.state.name());
        line.word(" ");
        line.celsius::<5>(self.0.setpoint);
        line.word(" ");
        line.celsius::<4>(self.0.display);
        for temperature in [self.0.sink, self.0.skin, self.0.room] {
            line.word(" ");
            line.celsius::<2>(temperature);
        }
        line.word(" ");
        line.force(self.0.force);
        for current in [self.0.demand, self.0.current] {
            line.word(" ");
            line.current(current);
        }
        line.word(" ");
        line.count(self.0.evaluations);
        line.word(" ");
        line.word(match self.0.state.fault() {
            Some(fault) => fault.name(),
            None if self.0.limited => "limited",
            None => "-",
        });
        line.fmt(f)
    }
}

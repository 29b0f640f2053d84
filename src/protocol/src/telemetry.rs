//! The line of streamed telemetry.

use core::fmt;

use thermal_device::command::{self, Command, FluxState, WithSourceFinger};
use thermal_device::events::{DeviceEvent, UnsolicitedReport};
use thermal_device::{FingerIndex, Telemetry, TelemetryFields};

use crate::command_handler::ExecuteOnStations;
use crate::line_buffer::LineBuffer;
use crate::reply::UNTUNED_WORD;

/// One finger's telemetry of a tick; `Display` writes it as a line to the host, without a line ending and in at most
/// 160 bytes:
///
/// `T tick state setpoint_c display_c sink_c skin_c room_c force_n demand_a current_a evaluations remark`
///
/// Before the remark, a line may also have `flux_w_m2 surface_c finger`, each only if the host has named it.
///
/// `tick` counts milliseconds since reset. `state` is the state of the finger's station. Temperatures are in °C, the
/// force is in N, the demanded current (positive cools) and the magnitude of the measured current are in A. A quantity
/// whose sensor has failed, and the set-point in a state without one, is written as `-`. `evaluations` counts since
/// reset how often the function `erfcx` was computed for set-points. `flux_w_m2`, the heat flux out of the skin, `surface_c`,
/// the estimate of the display's surface, and `finger`, what is known of the finger, are `-` without a heat-flux sensor. `remark` is the fault that tripped the station,
/// else `limited` if the set-point was limited to 15 to 42 °C, else `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelemetryLine {
    /// Readings, set-point and current.
    pub telemetry: Telemetry,
    /// What the heat-flux sensor shows; `None` without one, and if the host has named no field of it.
    pub flux: Option<FluxState>,
}

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
                flux: if telemetry.fields.has_flux_fields() {
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

impl fmt::Display for TelemetryLine {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = LineBuffer::new();
        let Self { telemetry, flux } = self;
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
                0 => line.push_celsius_or_dash(5, telemetry.setpoint),
                1 => line.push_celsius_or_dash(4, telemetry.display),
                2 => line.push_celsius_or_dash(2, telemetry.sink),
                3 => line.push_celsius_or_dash(2, telemetry.skin),
                4 => line.push_celsius_or_dash(2, telemetry.room),
                5 => line.push_force_or_dash(telemetry.force),
                6 => line.push_current(telemetry.demand),
                7 => line.push_current(telemetry.current),
                8 => line.push_integer(telemetry.evaluations),
                9 => line.push_flux_or_dash(flux.and_then(|state| state.flux)),
                10 => line.push_celsius_or_dash(4, flux.and_then(|state| state.surface)),
                _ => line.push_str_if_fits(flux.map_or("-", |state| state.knowledge.name())),
            }
        }
        line.push_str_if_fits(" ");
        line.push_str_if_fits(match telemetry.state.fault() {
            Some(fault) => fault.name(),
            None if telemetry.limited => "limited",
            None if !telemetry.is_tuned => UNTUNED_WORD,
            None => "-",
        });
        line.fmt(f)
    }
}

//! Telemetry lines.

use std::time::Duration;

use serde::Serialize;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_device::{StateName, TelemetryFields};
use thermal_protocol::UNTUNED_WORD;

use super::fields::{knowledge, knowledge_word_if_known, number_or_unknown, state, state_word};

/// The fields of a telemetry line; what the device does not know, or was not asked for, is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Telemetry {
    /// Ticks of 1 ms since the device's reset.
    pub tick: u32,
    /// State of the device, with its fault if it is tripped.
    #[serde(serialize_with = "state_word")]
    pub state: StateName,
    /// Set-point, °C.
    pub setpoint_c: Option<f64>,
    /// First display thermistor, °C.
    pub display_c: Option<f64>,
    /// Thermistor of the sink, °C.
    pub sink_c: Option<f64>,
    /// Thermistor of the skin, °C.
    pub skin_c: Option<f64>,
    /// Thermistor of the room, °C.
    pub room_c: Option<f64>,
    /// Force of the finger, N.
    pub force_n: Option<f64>,
    /// Demanded current, A; positive cools.
    pub demand_a: Option<f64>,
    /// Magnitude of the measured current, A.
    pub current_a: Option<f64>,
    /// Evaluations of `erfcx` since the device's reset.
    pub evaluations: Option<u32>,
    /// Heat flux out of the skin by the heat-flux sensor, W/m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flux_w_m2: Option<f64>,
    /// Estimate of the display's surface under the finger, °C, of a device with a heat-flux sensor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_c: Option<f64>,
    /// What is known of the finger by its flux.
    #[serde(serialize_with = "knowledge_word_if_known", skip_serializing_if = "Option::is_none")]
    pub finger: Option<FingerKnowledge>,
    /// Whether the set-point was limited to its range.
    pub limited: bool,
    /// Whether the line says that the tile was never identified; a line that says `limited` does not tell.
    pub is_untuned: bool,
}

/// Force below which a finger counts as lifted, N.
const LIFTED_N: f64 = 0.01;

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

impl Telemetry {
    /// Reads a line with the default fields, without its finger; `None` if it is not telemetry. Words after the known ones are ignored.
    pub fn parse(line: &str) -> Option<Self> {
        Self::parse_fields(line, TelemetryFields::DEFAULT)
    }

    /// The same of a line with these fields only; those that are left out are `None`. If there are any, the line has no other
    /// words, so that one with more fields is not taken for it.
    pub fn parse_fields(line: &str, fields: TelemetryFields) -> Option<Self> {
        let mut words = line.split(' ');
        let ("T", tick, state_name) = (words.next()?, words.next()?, words.next()?) else {
            return None;
        };
        let mut values = ["-"; TelemetryFields::NAMES.len()];
        for (index, value) in values.iter_mut().enumerate() {
            if fields.contains(index) {
                *value = words.next()?;
            }
        }
        let remark = words.next()?;
        if fields != TelemetryFields::DEFAULT && words.next().is_some() {
            return None;
        }
        let [
            setpoint,
            display,
            sink,
            skin,
            room,
            force,
            demand,
            current,
            evaluations,
            flux,
            surface,
            finger,
        ] = values;
        Some(Self {
            tick: tick.parse().ok()?,
            state: state(state_name, remark)?,
            setpoint_c: number_or_unknown(setpoint)?,
            display_c: number_or_unknown(display)?,
            sink_c: number_or_unknown(sink)?,
            skin_c: number_or_unknown(skin)?,
            room_c: number_or_unknown(room)?,
            force_n: number_or_unknown(force)?,
            demand_a: number_or_unknown(demand)?,
            current_a: number_or_unknown(current)?,
            evaluations: match evaluations {
                "-" => None,
                count => Some(count.parse().ok()?),
            },
            flux_w_m2: number_or_unknown(flux)?,
            surface_c: number_or_unknown(surface)?,
            finger: match finger {
                "-" => None,
                word => Some(knowledge(word)?),
            },
            limited: remark == "limited",
            is_untuned: remark == UNTUNED_WORD,
        })
    }

    /// Whether the finger does not press on the display; `None` if the force is not known.
    pub fn is_lifted(&self) -> Option<bool> {
        self.force_n.map(|force_n| force_n < LIFTED_N)
    }

    /// The tick that a telemetry line names, whatever its fields; `None` if it is not telemetry.
    pub(super) fn tick_of(line: &str) -> Option<u32> {
        line.strip_prefix("T ")?.split(' ').next()?.parse().ok()
    }

    /// The last word of the line: the fault by which the device is tripped, `limited` or `untuned`.
    pub const fn remark(&self) -> Option<&'static str> {
        match self.state.fault() {
            Some(fault) => Some(fault.name()),
            None if self.limited => Some("limited"),
            None if self.is_untuned => Some(UNTUNED_WORD),
            None => None,
        }
    }

    /// The fault by which the device is tripped.
    pub const fn fault(&self) -> Option<Fault> {
        self.state.fault()
    }
}

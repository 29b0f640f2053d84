//! Reading of a telemetry line.

use thermal_device::TelemetryFields;
use thermal_device::safety::Fault;

use super::{Telemetry, state};
use crate::telemetry::{DEFAULT_FIELDS, LIMITED_WORD, UNTUNED_WORD};

/// Force below which a finger counts as lifted, N.
const LIFTED_N: f64 = 0.01;

impl Telemetry {
    /// Reads a line with the default fields, without its finger; `None` if it is not telemetry. Words after the known ones are ignored.
    pub fn parse(line: &str) -> Option<Self> {
        Self::parse_fields(line, DEFAULT_FIELDS)
    }

    /// The same of a line with these fields only; those that are left out are `None`. If there are any, the line has no other
    /// words, so that one with more fields is not taken for it.
    pub fn parse_fields(line: &str, fields: TelemetryFields) -> Option<Self> {
        let mut words = line.split(' ');
        let ("T", tick, state_name) = (words.next()?, words.next()?, words.next()?) else {
            return None;
        };
        let mut read = Self::new(tick.parse().ok()?, thermal_device::StateName::Off);
        read.read_fields(fields, &mut words)?;
        let remark = words.next()?;
        if fields != DEFAULT_FIELDS && words.next().is_some() {
            return None;
        }
        Some(Self {
            state: state(state_name, remark)?,
            limited: remark == LIMITED_WORD,
            is_untuned: remark == UNTUNED_WORD,
            ..read
        })
    }

    /// The tick that a telemetry line names, whatever its fields; `None` if it is not telemetry.
    pub fn tick_of(line: &str) -> Option<u32> {
        line.strip_prefix("T ")?.split(' ').next()?.parse().ok()
    }

    /// Whether the finger does not press on the display; `None` if the force is not known.
    pub fn is_lifted(&self) -> Option<bool> {
        self.force_n.map(|force_n| force_n < LIFTED_N)
    }

    /// The last word of the line: the fault by which the device is tripped, `limited` or `untuned`.
    pub const fn remark(&self) -> Option<&'static str> {
        match self.fault() {
            Some(fault) => Some(fault.name()),
            None if self.limited => Some(LIMITED_WORD),
            None if self.is_untuned => Some(UNTUNED_WORD),
            None => None,
        }
    }

    /// The fault by which the device is tripped.
    pub const fn fault(&self) -> Option<Fault> {
        self.state.fault()
    }
}

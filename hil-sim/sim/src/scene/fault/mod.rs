//! Faults of a scene: kind, start and end.

mod defects;
mod documentation;
mod parse;
mod processor;
#[macro_use]
mod row;
mod kinds;

use serde::Deserialize;

pub(crate) use defects::ActiveDefects;
pub use documentation::{fault_names, fault_table};
pub use kinds::FaultKind;
pub(super) use parse::faults;
pub use processor::{ProcessorKey, ProcessorKind};
pub use row::ValueRange;

/// Drift rate of a thermistor, K/s.
pub const DRIFT_K_S: f64 = 1.0;

named_enum! {
    /// A thermistor of one finger, numbered as its channel in the converter's scan.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Sensor {
        /// In the face of the display; the control loop uses it.
        #[default]
        Display = "display",
        /// Beside it; the comparator watches it.
        Check = "check",
        /// On the sink.
        Sink = "sink",
        /// On the skin.
        Skin = "skin",
        /// In the room.
        Room = "room",
    }
}

/// A fault that is present now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveFault {
    /// Kind of the fault.
    pub kind: FaultKind,
    /// The thermistor, for kinds that affect one.
    pub sensor: Sensor,
    /// The second thermistor, for kinds that exchange two.
    pub with: Sensor,
    /// Present magnitude in the unit of the [kind's value](FaultKind::value); 0 for kinds without a value.
    pub value: f64,
}

impl From<FaultKind> for ActiveFault {
    /// The defaults of a scene: the display's thermistor and the default value of the kind.
    fn from(kind: FaultKind) -> Self {
        let value = kind.value().and_then(|value| value.default);
        Self { kind, sensor: Sensor::Display, with: Sensor::Display, value: value.unwrap_or(0.0) }
    }
}

/// A fault of a scene with its start and end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScheduledFault {
    /// The fault; a drift ends at its value.
    pub fault: ActiveFault,
    /// Start, s.
    pub t_s: f64,
    /// End, s; infinite for a permanent fault.
    pub until_s: f64,
}

impl ScheduledFault {
    /// The fault as it is at a time, s; `None` if it is not present. A drift grows from its start on.
    pub fn at(&self, t_s: f64) -> Option<ActiveFault> {
        if !(self.t_s..self.until_s).contains(&t_s) {
            return None;
        }
        let mut now = self.fault;
        if now.kind == FaultKind::ThermistorDrift {
            let most_k = DRIFT_K_S * (t_s - self.t_s);
            now.value = now.value.clamp(-most_k, most_k);
        }
        Some(now)
    }
}

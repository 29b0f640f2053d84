//! What breaks in a scene, when, and for how long.

mod kinds;
mod parse;
mod processor;

use serde::Deserialize;

pub use kinds::{FaultKind, Value};
pub(super) use parse::faults;
pub use processor::{ProcessorKey, ProcessorKind};

/// Rate at which a thermistor drifts, K/s.
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

/// Something that is broken now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveFault {
    /// What.
    pub kind: FaultKind,
    /// Which thermistor, of kinds that break one.
    pub sensor: Sensor,
    /// The other thermistor, of kinds that confuse two.
    pub with: Sensor,
    /// How much now, in the unit of the [kind's value](FaultKind::value); 0 of kinds without.
    pub value: f64,
}

impl From<FaultKind> for ActiveFault {
    /// As a scene has it that says no more: of the display's thermistor, with the value that such a scene means.
    fn from(kind: FaultKind) -> Self {
        let value = kind.value().and_then(|value| value.default);
        Self {
            kind,
            sensor: Sensor::Display,
            with: Sensor::Display,
            value: value.unwrap_or(0.0),
        }
    }
}

/// Something that breaks in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// What; its value is what it comes to.
    pub broken: ActiveFault,
    /// From when on, s.
    pub t_s: f64,
    /// Until when, s; infinite if it stays.
    pub until_s: f64,
}

impl Fault {
    /// What is broken at a time, s; a drift is on its way.
    #[must_use]
    pub fn at(&self, t_s: f64) -> Option<ActiveFault> {
        if !(self.t_s..self.until_s).contains(&t_s) {
            return None;
        }
        let mut now = self.broken;
        if now.kind == FaultKind::ThermistorDrift {
            let most_k = DRIFT_K_S * (t_s - self.t_s);
            now.value = now.value.clamp(-most_k, most_k);
        }
        Some(now)
    }
}

#[cfg(test)]
mod tests;

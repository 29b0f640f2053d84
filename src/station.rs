//! One finger's device, without its hardware.

use crate::drive::Drive;
use crate::protocol::{Command, Error, Reply, Telemetry};
use crate::sense::Samples;
use crate::settings::Settings;

/// One finger's display: samples in, bridge command out, once per tick.
#[derive(Debug)]
pub struct Station {
    tick: u32,
}

impl Station {
    /// A station that is off.
    #[must_use]
    pub const fn new(_settings: Settings) -> Self {
        Self { tick: 0 }
    }

    /// One control tick.
    pub fn step(&mut self, _samples: &Samples) -> Drive {
        self.tick = self.tick.wrapping_add(1);
        Drive::Off
    }

    /// Telemetry of the last tick, if the host asked for it.
    #[must_use]
    pub fn telemetry(&self) -> Option<Telemetry> {
        Some(Telemetry { tick: self.tick })
    }

    /// Executes a command of the host, in bounded and short time.
    pub fn execute(&mut self, _command: Command) -> Result<Reply, Error> {
        Ok(Reply)
    }
}

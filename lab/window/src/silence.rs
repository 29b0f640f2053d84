//! Telemetry that does not come although the device was asked for it.

use std::time::Duration;

use thermal_client::client::{Client, longest_gap};
use thermal_client::link::Link;

/// Watches whether telemetry comes.
pub struct Silence {
    longest_gap: Duration,
    /// When the last line came, by the link's clock, and how many lines had not been understood by then.
    last_at: Duration,
    damaged: u64,
    is_said: bool,
}

impl Silence {
    /// Of a device that has just been asked for telemetry at an interval, ms.
    pub fn new<L: Link>(interval_ms: u32, client: &mut Client<L>) -> Self {
        Self {
            longest_gap: longest_gap(interval_ms),
            last_at: client.link().now(),
            damaged: client.counts().damaged,
            is_said: false,
        }
    }

    /// What is to be said, once, when telemetry comes again.
    pub fn ends<L: Link>(&mut self, client: &mut Client<L>) -> Option<String> {
        let was_said = self.is_said;
        (self.last_at, self.damaged) = (client.link().now(), client.counts().damaged);
        self.is_said = false;
        was_said.then(|| "telemetry comes again".into())
    }

    /// What is to be said, once, when no telemetry has come for too long.
    pub fn lasts<L: Link>(&mut self, client: &mut Client<L>) -> Option<String> {
        let silent = client.link().now().saturating_sub(self.last_at);
        if self.is_said || silent <= self.longest_gap {
            return None;
        }
        self.is_said = true;
        Some(format!(
            "no telemetry for {:.1} s ({} lines not understood): what is shown is old, and the bridge may be on",
            silent.as_secs_f64(),
            client.counts().damaged - self.damaged
        ))
    }
}

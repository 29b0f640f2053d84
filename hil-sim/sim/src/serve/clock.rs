//! When the next millisecond of a served device is due.

use std::thread::sleep;
use std::time::{Duration, Instant};

/// How fast the time of a served device passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// As real time does.
    RealTime,
    /// As fast as it goes while a client is connected.
    Max,
}

/// Delay beyond which the machine does not keep up with real time.
const LATE: Duration = Duration::from_millis(100);
/// Time that a device at [`Speed::Max`] goes on after its client has gone, ms: long enough to trip with `host-silent`, which
/// takes 2 s.
const RUN_ON_MS: u64 = 10_000;
/// Interval at which a device whose time stands still looks for a client.
const IDLE: Duration = Duration::from_millis(5);

/// Paces a served device.
#[derive(Debug)]
pub struct Clock {
    speed: Speed,
    /// Start of the device's time.
    start: Instant,
    /// Milliseconds run so far.
    ms: u64,
    late: bool,
    /// Milliseconds that a device at [`Speed::Max`] still runs without a client.
    run_on_ms: u64,
}

impl Clock {
    /// A clock that starts now.
    pub fn start(speed: Speed) -> Self {
        Self { speed, start: Instant::now(), ms: 0, late: false, run_on_ms: 0 }
    }

    /// Start of the device's time.
    pub const fn started(&self) -> Instant {
        self.start
    }

    /// Lets time go on from now, after it has stood still.
    pub fn resume(&mut self) {
        self.start = Instant::now() - Duration::from_millis(self.ms);
    }

    /// Waits until the next millisecond is due and returns true; or returns false after a while, because the time of the
    /// device stands still. In real time a millisecond is due at its end, counted from the start, so that there is no drift.
    /// At [`Speed::Max`] time stands still before the first client comes, and 10 s after a client has gone.
    pub fn wait_for_next_ms(&mut self, connected: bool) -> bool {
        match self.speed {
            Speed::RealTime => self.wait_for_real_time(),
            Speed::Max if connected => self.run_on_ms = RUN_ON_MS,
            Speed::Max if self.run_on_ms > 0 => self.run_on_ms -= 1,
            Speed::Max => {
                sleep(IDLE);
                return false;
            }
        }
        self.ms += 1;
        true
    }

    fn wait_for_real_time(&mut self) {
        let due = self.start + Duration::from_millis(self.ms + 1);
        let now = Instant::now();
        if let Some(early) = due.checked_duration_since(now) {
            sleep(early);
        } else if now - due > LATE && !self.late {
            self.late = true;
            eprintln!(
                "hil-sim: this machine cannot keep up with real time: after {:.1} s the device is {} ms late",
                self.ms as f64 / 1e3,
                (now - due).as_millis()
            );
        }
    }
}

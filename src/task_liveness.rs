//! Task liveness: the independent watchdog is fed only while every task that matters keeps running.

use core::sync::atomic::{AtomicU8, Ordering};

/// A task that must run regularly, or the watchdog resets the device.
#[derive(Clone, Copy, Debug)]
pub enum Task {
    /// The control tick, which samples the sensors and drives the bridges.
    Tick = 1 << 0,
    /// The task that answers the host.
    Host = 1 << 1,
}

const ALL: u8 = Task::Tick as u8 | Task::Host as u8;

/// The tasks that have checked in since the watchdog was last fed.
///
/// The idle task reads it. It runs only when the other tasks leave it time, so it needs no bit of
/// its own.
#[derive(Debug, Default)]
pub struct TaskLiveness(AtomicU8);

impl TaskLiveness {
    /// No task has checked in.
    pub const fn new() -> Self {
        Self(AtomicU8::new(0))
    }

    /// Records that `task` has run.
    pub fn check_in(&self, task: Task) {
        self.0.fetch_or(task as u8, Ordering::Relaxed);
    }

    /// Whether every task has checked in; if so, all must check in again before this returns `true`
    /// once more.
    pub fn all_checked_in(&self) -> bool {
        self.0
            .compare_exchange(ALL, 0, Ordering::Relaxed, Ordering::Relaxed)
            .is_ok()
    }
}

/// Counts the ticks until the host task is called although nothing waits for it, so that it can
/// check in.
#[derive(Debug, Default)]
pub struct HostPoll {
    ticks_left: u8,
}

impl HostPoll {
    /// Ticks from one call to the next: 9 ms at most, far below the watchdog's shortest period of
    /// 68 ms.
    const HOST_POLL_INTERVAL_TICKS: u8 = 9;

    /// A call is due at the first tick.
    pub const fn new() -> Self {
        Self { ticks_left: 0 }
    }

    /// Counts one tick; whether a call is due, which it is at once if telemetry is. It stays due
    /// until [`restart`](Self::restart).
    pub const fn is_due(&mut self, telemetry_is_due: bool) -> bool {
        self.ticks_left = match telemetry_is_due {
            true => 0,
            false => self.ticks_left.saturating_sub(1),
        };
        self.ticks_left == 0
    }

    /// Begins a new interval, after a call.
    pub const fn restart(&mut self) {
        self.ticks_left = Self::HOST_POLL_INTERVAL_TICKS;
    }
}

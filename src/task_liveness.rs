//! Task liveness: the independent watchdog is fed only while every task that matters keeps running.

use core::sync::atomic::{AtomicU8, Ordering};

/// A task that must check in before the independent watchdog is fed. If one of them stops, the
/// watchdog resets the device 68 to 188 ms after the last feeding. The values are the bits of
/// [`TaskLiveness`].
#[derive(Clone, Copy, Debug)]
pub enum Task {
    /// The task of the control tick, which samples the sensors and drives the bridges.
    Tick = 1 << 0,
    /// The task that answers the host's lines and sends telemetry; [`HostTaskTimer`] ensures that
    /// it is called at least every nine ticks.
    Host = 1 << 1,
}

const ALL_TASKS: u8 = Task::Tick as u8 | Task::Host as u8;

/// The set of tasks that have checked in since the independent watchdog was last fed, one bit for
/// each [`Task`].
///
/// The idle task feeds the watchdog when the set is complete. The idle task has no bit of its own:
/// if it does not run, nothing feeds the watchdog.
#[derive(Debug, Default)]
pub struct TaskLiveness(AtomicU8);

impl TaskLiveness {
    /// Creates the set, with no task checked in.
    pub const fn new() -> Self {
        Self(AtomicU8::new(0))
    }

    /// Records that `task` has run since the independent watchdog was last fed.
    pub fn check_in(&self, task: Task) {
        self.0.fetch_or(task as u8, Ordering::Relaxed);
    }

    /// Whether every [`Task`] has checked in, so that the watchdog may be fed. If so, clears the
    /// set: all tasks must check in again before this function returns `true` again.
    pub fn clear_if_all_checked_in(&self) -> bool {
        self.0.compare_exchange(ALL_TASKS, 0, Ordering::Relaxed, Ordering::Relaxed).is_ok()
    }
}

/// Counts control ticks so that the host task is called at least every nine ticks, even if no line
/// and no telemetry waits. Otherwise an idle host task would not check in with [`TaskLiveness`],
/// and the independent watchdog would reset the device.
#[derive(Debug, Default)]
pub struct HostTaskTimer {
    ticks_left: u8,
}

impl HostTaskTimer {
    /// Number of control ticks after which the host task is called again if no telemetry is due
    /// before: 9 ms with one finger, 1.8 ms with five. This is far below 68 ms, the shortest period
    /// of the independent watchdog, within which the host task must check in.
    const MAX_INTERVAL_TICKS: u8 = 9;

    /// Creates the timer; the host task is due at the first tick.
    pub const fn new_due_at_first_tick() -> Self {
        Self { ticks_left: 0 }
    }

    /// Counts one tick and returns whether the host task must be called: at once if
    /// `telemetry_is_due`, else when the interval has elapsed. The result stays `true` until
    /// [`restart`](Self::restart).
    pub const fn count_tick_and_check_due_or_telemetry(&mut self, telemetry_is_due: bool) -> bool {
        self.ticks_left = match telemetry_is_due {
            true => 0,
            false => self.ticks_left.saturating_sub(1),
        };
        self.ticks_left == 0
    }

    /// Starts a new interval of nine ticks, at the end of which the host task is due again. To be
    /// called when the host task has been called.
    pub const fn restart(&mut self) {
        self.ticks_left = Self::MAX_INTERVAL_TICKS;
    }
}

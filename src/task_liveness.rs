//! The roll-call on which the watchdog depends.

use core::sync::atomic::{AtomicU8, Ordering};

/// A task that must run for the device to be alive.
#[derive(Clone, Copy, Debug)]
pub enum Task {
    /// The control tick: samples arrive, the bridge is told what to do.
    Tick = 1 << 0,
    /// The host task: commands would be answered.
    Host = 1 << 1,
}

const ALL: u8 = Task::Tick as u8 | Task::Host as u8;

/// Who has checked in since everybody was last present. The idle task, which asks, proves by asking that
/// the tasks above it leave time.
#[derive(Debug)]
pub struct TaskLiveness(AtomicU8);

impl TaskLiveness {
    /// Nobody has checked in.
    pub const fn new() -> Self {
        Self(AtomicU8::new(0))
    }

    /// `task` has done one round of its work.
    pub fn check_in(&self, task: Task) {
        self.0.fetch_or(task as u8, Ordering::Relaxed);
    }

    /// Whether every task has checked in since this was last true.
    pub fn all_checked_in(&self) -> bool {
        self.0
            .compare_exchange(ALL, 0, Ordering::Relaxed, Ordering::Relaxed)
            .is_ok()
    }
}

//! How much faster than real time a run was.

use std::time::Instant;

use serde::Serialize;

/// When a run began and ended, on the clock of this computer.
#[derive(Clone, Copy, Debug)]
pub struct RunClock {
    /// When the user's wait began. A run starts it before commissioning; a program that has worked for the run before, or has
    /// compiled the image meanwhile, moves it.
    pub began: Instant,
    loop_began: Instant,
    ended: Instant,
    /// Time that the loop has simulated, s.
    loop_s: f64,
}

impl RunClock {
    /// The clock of a run that has just recorded its last row. Its loop has simulated `loop_ms` since `loop_began`.
    pub(crate) fn at_last_row(began: Instant, loop_began: Instant, loop_ms: u64) -> Self {
        Self { began, loop_began, ended: Instant::now(), loop_s: loop_ms as f64 * 1e-3 }
    }

    /// The speed of a run of a scene of this length, s.
    pub fn speed(&self, scene_s: f64) -> Speed {
        let until_end_s = |since: Instant| (self.ended - since).as_secs_f64();
        Speed {
            real_time_factor: scene_s / until_end_s(self.began),
            loop_real_time_factor: self.loop_s / until_end_s(self.loop_began),
        }
    }
}

/// Ratios of simulated time to wall time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// What a user waits for: length of the scene over the time from the start of the program (in a campaign: of the run) to
    /// the last row. Commissioning and settling count as waiting, compiling the image does not.
    pub real_time_factor: f64,
    /// Of the simulation's loop alone: set-up, settling and scene over its run time, without commissioning.
    pub loop_real_time_factor: f64,
}
